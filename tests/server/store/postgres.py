"""A PostgreSQL server of our own, started from the machine's package, gone after the test."""

from __future__ import annotations

import os
import pwd
import shutil
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import psycopg

ROOT = Path(__file__).resolve().parents[3]


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as found:
        return int(found.getsockname()[1])


@contextmanager
def postgres() -> Iterator[str]:
    """Start a server on loopback and return its address; it does not run as root, so it gets another user."""
    programs = Path(
        subprocess.run([ROOT / "scripts" / "postgres"], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
    )
    user = pwd.getpwnam("nobody") if os.getuid() == 0 else pwd.getpwuid(os.getuid())
    options = {"user": user.pw_uid, "group": user.pw_gid, "extra_groups": []} if os.getuid() == 0 else {}
    folder = Path(tempfile.mkdtemp(prefix="combbench-postgres-"))
    os.chown(folder, user.pw_uid, user.pw_gid)
    port = free_port()
    try:
        subprocess.run(
            [programs / "initdb", "-D", folder / "data", "-U", "bench", "-A", "trust", "-E", "UTF8", "--no-sync"],
            cwd=folder, check=True, capture_output=True, **options,
        )  # fmt: skip
        with (folder / "log").open("wb") as log:
            server = subprocess.Popen(
                [programs / "postgres", "-D", folder / "data", "-h", "127.0.0.1", "-p", str(port), "-k", "", "-F"],
                cwd=folder, stdout=log, stderr=log, **options,
            )  # fmt: skip
        try:
            address = f"postgresql://bench@127.0.0.1:{port}"
            _until_it_answers(address, server, folder / "log")
            yield address
        finally:
            server.terminate()
            server.wait(20)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _until_it_answers(address: str, server: subprocess.Popen[bytes], log: Path) -> None:
    end = time.monotonic() + 30
    while True:
        try:
            psycopg.connect(f"{address}/postgres").close()
            return
        except psycopg.OperationalError:
            assert time.monotonic() < end and server.poll() is None, log.read_text()
            time.sleep(0.05)


def new_database(address: str, name: str) -> str:
    """Make an empty database and return its address."""
    with psycopg.connect(f"{address}/postgres", autocommit=True) as connection:
        connection.execute(f'DROP DATABASE IF EXISTS "{name}" WITH (FORCE)')
        connection.execute(f'CREATE DATABASE "{name}"')
    return f"{address}/{name}"
