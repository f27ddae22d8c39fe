"""Settings of the service: one model with an explanation of every value, read from four sources."""

from __future__ import annotations

import os
from dataclasses import dataclass
from ipaddress import ip_address, ip_network
from pathlib import Path
from typing import Any, Literal

from pydantic import Field, SecretStr, ValidationError, field_validator, model_validator
from pydantic_settings import (
    BaseSettings,
    InitSettingsSource,
    PydanticBaseSettingsSource,
    SettingsConfigDict,
)

from core.errors import InputError
from core.nesting import read_toml
from scenarios.reading import read_text
from server.security.platforms import Platform
from server.security.public import PublicOrigin

CONFIG_FILE = Path("combbench.toml")
PREFIX = "COMBBENCH_"
ANY_IPV4, ANY_IPV6 = "0.0.0.0", "::"


class Settings(BaseSettings):
    """All settings of the service; command line > environment > combbench.toml > default."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, extra="forbid")

    host: str = Field(
        "127.0.0.1",
        description="Address on which the server listens. An address that other machines reach needs `token`, or "
        "`classroom`, whose default is 0.0.0.0.",
    )
    port: int = Field(8000, ge=0, le=65535, description="Port on which the server listens; 0 chooses a free one.")
    data: Path = Field(Path("data"), description="Folder of the database, the recordings and the results of runs.")
    database_url: str = Field(
        "", repr=False, description="Address of the database, such as `postgresql://...`; SQLite in `data` if unset."
    )
    token: SecretStr | None = Field(
        None, description="Access token; if unset, the server makes one in the data folder."
    )
    allowed_hosts: list[str] = Field([], description="Further host names under which browsers may open the page.")
    public_origin: str = Field(
        "",
        description="Address of the page behind a proxy (docs/behind-a-proxy.md), such as `https://lab.example` or "
        "`https://lab.example/bench`.",
    )
    trusted_proxies: list[str] = Field(
        [],
        description="Addresses or networks of proxies; limits count the addresses in their `X-Forwarded-For`.",
    )
    classroom: bool = Field(
        False,
        description="Serve a class on this network without TLS (docs/teaching.md); the token then works on this "
        "machine alone.",
    )
    lti: list[Platform] = Field(
        [], description="Learning platforms that may launch the bench by LTI 1.3, as tables `[[lti]]`: docs/lti.md."
    )
    units: Literal["off", "teacher", "everyone"] = Field(
        "teacher",
        description="Persons whose scenarios may carry user units (docs/own-units.md): `off`, `teacher` or `everyone`, "
        "which needs the extra `wall` (docs/other-languages.md).",
    )
    unit_files: list[Path] = Field(
        [],
        description="Files of user units that every new bench has, one unit each; `--unit FILE` on the command line.",
    )
    instrument_port: int | None = Field(
        None,
        ge=0,
        le=65535,
        description="Port on which instruments send their samples (docs/your-device.md); 0 chooses a free one, and "
        "unset takes no instrument.",
    )
    instrument_host: str = Field("127.0.0.1", description="Address on which the server listens for instruments.")
    instrument_peers: list[str] = Field(
        ["127.0.0.0/8", "::1"], description="Addresses or networks from which instruments may connect."
    )
    instrument_samples: int = Field(
        100_000_000, ge=1000, description="Samples of the longest record of an instrument; one takes 16 bytes of disk."
    )
    metrics_open: bool = Field(False, description="Serve `/metrics` without a token.")
    open_page: bool = Field(False, description="Open the page in a browser once the server answers.")

    max_benches: int = Field(16, ge=1, le=256, description="Live benches at once.")
    idle_minutes: float = Field(
        15.0,
        ge=0,
        description="Minutes until an unused bench is closed; its address opens it again unchanged. 0 closes none.",
    )
    max_students: int = Field(
        60,
        ge=1,
        le=500,
        description="Students of all classes; each has a bench that does not count as one of `max_benches`.",
    )
    student_history_mb: int = Field(
        16, ge=1, le=10_000, description="MB of memory for the history of a student's bench."
    )
    student_ticks_per_s: int = Field(20_000, ge=100, description="Most ticks that a student's bench runs in a second.")
    student_events: int = Field(1000, ge=1, description="Most events of a student's scenario.")
    max_links: int = Field(10_000, ge=0, description="Experiments and layouts that the server keeps for links.")
    max_clients: int = Field(512, ge=1, description="Open streams over all benches.")
    max_clients_per_bench: int = Field(256, ge=1, description="Open streams of one bench.")
    max_snapshots: int = Field(32, ge=1, description="Snapshots kept per bench.")
    max_queued_runs: int = Field(256, ge=1, description="Headless runs and campaigns waiting or running.")
    max_run_seeds: int = Field(200, ge=1, description="Seeds of one headless run.")
    max_run_ticks: int = Field(20_000_000, ge=1, description="Ticks of one headless run, over all its seeds.")
    max_run_mb: int = Field(
        1000,
        ge=1,
        description="MB of numbers in the trace of a run; beyond, it lacks taps, then outputs that no figure needs.",
    )
    max_sweep_runs: int = Field(100_000, ge=1, description="Runs of one campaign.")
    max_recording_ticks: int = Field(20_000_000, ge=1, description="Ticks of one recording.")
    max_record_mb: int = Field(
        64, ge=1, le=1000, description="MB of one record of a device: of its file, and of its samples in memory."
    )
    student_record_mb: int = Field(8, ge=1, le=1000, description="MB of one record of a student.")
    quota_bytes: int = Field(
        50_000_000_000,
        ge=0,
        description="Bytes of recordings, records, runs and their database; beyond, the server refuses new ones.",
    )
    disk_reserve_bytes: int = Field(
        100_000_000,
        ge=0,
        description="Bytes of the disk that stay free: with less, recordings end and runs are refused.",
    )
    retention_days: float = Field(
        0.0, ge=0, description="Days for which recordings and runs are kept; 0 keeps them without limit."
    )
    max_trace_ticks: int = Field(200_000, ge=1, description="Ticks of one full-rate trace download.")
    history_ticks: int = Field(
        200_000, ge=2_000, le=5_000_000, description="Most ticks of each signal in the history of a bench."
    )
    history_mb: int = Field(72, ge=1, le=10_000, description="MB of memory for the history of a bench.")

    body_limit_bytes: int = Field(1 << 20, ge=1024, description="Bytes of the largest request body.")
    message_limit_bytes: int = Field(
        64 << 10, ge=1024, description="Bytes of the largest WebSocket message from a client."
    )
    command_rate_per_s: float = Field(
        20.0, gt=0, description="Commands a second that a client may send in the long run."
    )
    command_burst: int = Field(40, ge=1, description="Commands that a client may send at once.")
    frame_rate_hz: float = Field(60.0, gt=0, le=120, description="Frames a second of a stream.")

    clock: Literal["machine", "manual"] = Field(
        "machine",
        description="Clock of benches and limits; `manual` is for tests on loopback, where requests advance it.",
    )
    run_workers: int = Field(
        1, ge=0, le=64, description="Processes that compute headless runs and campaigns; 0 refuses them."
    )
    figures: bool = Field(True, description="Make missing figures when the gallery is opened, at low priority.")
    scheduler: str = Field(
        "",
        description="Address of a Dask scheduler for campaigns (docs/scaling.md); processes of this machine if unset.",
    )
    log_format: str = Field(
        "auto",
        pattern="^(auto|text|json)$",
        description="Form of log lines: `text`, `json`, or `auto`: text in a terminal, else JSON.",
    )
    log_level: str = Field(
        "INFO", pattern="^(DEBUG|INFO|WARNING|ERROR)$", description="Least severe level that is logged."
    )

    @field_validator("trusted_proxies", "instrument_peers")
    @classmethod
    def _are_networks(cls, given: list[str]) -> list[str]:
        """Refuse a text that is neither an address nor a network."""
        return [str(ip_network(one)) for one in given]

    @field_validator("public_origin")
    @classmethod
    def _as_browsers_write_it(cls, given: str) -> str:
        """Check the address, and write it as browsers do."""
        return str(PublicOrigin.parse(given))

    @model_validator(mode="after")
    def _open_to_the_class(self) -> Settings:
        """Listen to the network for a class, unless an address to listen on is given."""
        if self.classroom and "host" not in self.model_fields_set:
            self.host = ANY_IPV4
        return self

    @model_validator(mode="after")
    def _no_strangers_at_a_manual_clock(self) -> Settings:
        """Refuse a clock that requests advance where other machines could reach it."""
        if self.clock == "manual" and (not self.is_loopback or self.public_origin):
            raise ValueError("clock = manual is for tests: host must be this machine alone, without public_origin")
        return self

    @property
    def is_loopback(self) -> bool:
        """Whether only this machine can reach the service."""
        if self.host == "localhost":
            return True
        try:
            return ip_address(self.host).is_loopback
        except ValueError:
            return False

    @classmethod
    def settings_customise_sources(
        cls,
        settings_cls: type[BaseSettings],
        init_settings: PydanticBaseSettingsSource,
        env_settings: PydanticBaseSettingsSource,
        dotenv_settings: PydanticBaseSettingsSource,  # noqa: ARG003
        file_secret_settings: PydanticBaseSettingsSource,  # noqa: ARG003
    ) -> tuple[PydanticBaseSettingsSource, ...]:
        """Order the sources; no .env file, no secrets folder."""
        return init_settings, env_settings, InitSettingsSource(settings_cls, _file_values())


@dataclass(frozen=True)
class EffectiveSetting:
    """One setting as it is in force, and where it comes from."""

    name: str
    value: str
    source: str
    meaning: str


def load_settings(**given: Any) -> Settings:
    """Read the settings, with the values given on the command line on top.

    Parameters
    ----------
    **given
        Values by field name; ``None`` means "not given".

    Raises
    ------
    InputError
        One line naming the setting and its source.
    """
    values = {name: value for name, value in given.items() if value is not None}
    try:
        return Settings(**values)
    except ValidationError as error:
        first = error.errors()[0]
        place = [str(part) for part in first["loc"]] or [""]
        name = place[0]
        if first["type"] == "extra_forbidden":
            raise InputError(f"unknown setting '{'.'.join(place)}' in {CONFIG_FILE}", field=name) from None
        source = _source(name, values, _file_values())
        reason = first["msg"].removeprefix("Value error, ").lower()
        raise InputError(f"setting '{'.'.join(place)}' from {source}: {reason}", field=name) from None


def describe_settings(settings: Settings, **given: Any) -> list[EffectiveSetting]:
    """List every effective setting with its source, secrets hidden."""
    values = {name: value for name, value in given.items() if value is not None}
    file_values = _file_values()
    rows = []
    for name, field in Settings.model_fields.items():
        source, value = _source(name, values, file_values), str(getattr(settings, name))
        if name == "host" and source == "default" and settings.classroom:
            source = "classroom"
        shown = without_password(value) if name == "database_url" else value
        rows.append(EffectiveSetting(name, shown, source, field.description or ""))
    return rows


def without_password(address: str) -> str:
    """Return the address of a database as it may be shown."""
    from sqlalchemy import make_url  # a slow import that only this function needs
    from sqlalchemy.exc import ArgumentError

    try:
        url = make_url(address)
    except (ArgumentError, ValueError):
        return "***" if address else ""
    hidden = {name: "..." for name in url.query if "pass" in name.lower()}
    return url.update_query_dict(hidden).render_as_string(hide_password=True)


def _source(name: str, values: dict[str, Any], file_values: dict[str, Any]) -> str:
    """Name the source that wins for one setting."""
    if name in values:
        return "command line"
    variable = PREFIX + name.upper()
    if any(key.upper() == variable for key in os.environ):
        return f"environment {variable}"
    return str(CONFIG_FILE) if name in file_values else "default"


def _file_values() -> dict[str, Any]:
    """Read combbench.toml if there is one."""
    return read_toml(read_text(CONFIG_FILE, ""), str(CONFIG_FILE)) if CONFIG_FILE.exists() else {}
