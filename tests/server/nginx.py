"""nginx in front of a service, with TLS, as docs/behind-a-proxy.md sets it up.

``python -m tests.server.nginx PORT SERVICE_PORT PREFIX`` runs one for the tests in a browser, until its input ends.
"""

from __future__ import annotations

import re
import socket
import subprocess
import sys
import tempfile
import textwrap
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NAME = "lab.example"
WHOLE = """\
daemon off;
master_process off;
pid {folder}/pid;
error_log {folder}/error.log;
events {{}}
http {{
    client_body_temp_path {folder}/body;
    proxy_temp_path {folder}/proxy;
    fastcgi_temp_path {folder}/fastcgi;
    uwsgi_temp_path {folder}/uwsgi;
    scgi_temp_path {folder}/scgi;
{site}
}}
"""


def site(folder: Path, port: int, services: dict[str, int]) -> str:
    """Return the text of the document, with the ports and paths of the test: the port of each service by its prefix."""
    whole, below = re.findall(r"```nginx\n(.*?)```", (ROOT / "docs" / "behind-a-proxy.md").read_text(), re.S)
    if "" not in services:
        blocks = [below.replace("/bench/", f"{prefix}/").replace("8000", str(to)) for prefix, to in services.items()]
        here = textwrap.indent("".join(blocks), "    ")
        whole, count = re.subn(r"    location / \{.*?\n    \}\n", lambda _: here, whole, flags=re.S)
        assert count == 1
    for said, meant in {
        "listen 443 ssl": f"listen 127.0.0.1:{port} ssl",
        "127.0.0.1:8000": f"127.0.0.1:{services.get('')}",
        "/etc/ssl": str(folder),
        "/var/log/nginx": str(folder),
    }.items():
        assert said in whole or ("8000" in said and "" not in services), said
        whole = whole.replace(said, meant)
    return whole


def make_certificate(folder: Path) -> None:
    """Make a certificate that vouches for itself."""
    command = "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2"
    where = ["-keyout", f"{folder}/{NAME}.key", "-out", f"{folder}/{NAME}.pem"]
    about = ["-subj", f"/CN={NAME}", "-addext", f"subjectAltName=DNS:{NAME}"]
    subprocess.run([*command.split(), *where, *about], check=True, capture_output=True)


@contextmanager
def nginx(port: int, services: dict[str, int]) -> Iterator[Path]:
    """Run nginx on a port of loopback, in front of services on others; yield its folder, with its certificate."""
    found = subprocess.run([ROOT / "scripts" / "nginx"], stdout=subprocess.PIPE, text=True, check=True)
    with tempfile.TemporaryDirectory(prefix="combbench-nginx-") as name:
        folder = Path(name)
        make_certificate(folder)
        (folder / "nginx.conf").write_text(WHOLE.format(folder=folder, site=site(folder, port, services)))
        command = [found.stdout.strip(), "-p", name, "-e", f"{name}/error.log", "-c", f"{name}/nginx.conf"]
        running = subprocess.Popen(command)
        try:
            end = time.monotonic() + 20
            while True:
                assert running.poll() is None and time.monotonic() < end, (folder / "error.log").read_text()
                try:
                    socket.create_connection(("127.0.0.1", port), 1).close()
                    break
                except OSError:
                    time.sleep(0.02)
            yield folder
        finally:
            running.terminate()
            running.wait(20)


if __name__ == "__main__":
    with nginx(int(sys.argv[1]), {sys.argv[3]: int(sys.argv[2])}):
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        sys.stdin.read()
