"""What a user can choose about where the jobs of a fleet run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..errors import Problem
from .choice import OUTPUT, Options, choice

WHERE = "Where"
"""Panel of the help."""

LOCAL = "local"
"""What is given for a scheduler to have one of one's own, on this machine alone."""


@dataclass(frozen=True)
class FleetOptions(Options):
    """All choices of a run of a fleet."""

    workers: int | None = choice(
        None, "Worker processes on this machine. Default: one a core.", least=1, most=1024, panel=WHERE
    )
    scheduler: str | None = choice(
        None,
        "Dask scheduler that hands the jobs out, such as tcp://HOST:8786 or tls://HOST:8786; "
        "local: one of its own on this machine.",
        panel=WHERE,
    )
    tls_ca: Path | None = choice(None, "Certificate of who signed the scheduler's, for tls://.", panel=WHERE)
    tls_cert: Path | None = choice(None, "Own certificate for tls://.", panel=WHERE)
    tls_key: Path | None = choice(None, "Key of that certificate.", panel=WHERE)
    retry: bool = choice(False, "Run jobs that failed before once more.")
    job_reports: bool = choice(
        True,
        "Do not render the report of each job, which takes time; mmgtune report FOLDER makes one when it is wanted.",
        flag="--no-job-reports",
        panel=OUTPUT,
    )

    @property
    def tls(self) -> dict[str, Path]:
        """The files of TLS that are given, by field."""
        given = {name: getattr(self, name) for name in ("tls_ca", "tls_cert", "tls_key")}
        return {name: path for name, path in given.items() if path is not None}

    def problems(self) -> list[Problem]:
        """What makes no sense; TLS wants a scheduler, and all three files."""
        found = super().problems()
        secure = (self.scheduler or "").startswith("tls://")
        lacking = [name for name in ("tls_ca", "tls_cert", "tls_key") if name not in self.tls]
        if self.tls and not secure:
            why = "certificates are for a scheduler whose address begins with tls://"
            found.append(Problem("certificates without a scheduler that asks for them", next(iter(self.tls)), why))
        if secure and lacking:
            fix = f"add {', '.join(f'{name}=FILE' for name in lacking)}"
            found.append(
                Problem(
                    "a scheduler at tls:// wants certificates",
                    "scheduler",
                    "it lets in who has certificates alone",
                    fix,
                )
            )
        if self.scheduler not in (None, LOCAL) and "://" not in str(self.scheduler):
            fix = f"write tcp://{self.scheduler}, or tls://{self.scheduler} where it wants certificates"
            found.append(
                Problem(
                    f"'{self.scheduler}' is no address of a scheduler",
                    "scheduler",
                    "it does not say how to speak to it",
                    fix,
                )
            )
        if self.workers is not None and self.scheduler not in (None, LOCAL):
            why = "a scheduler has the workers that were started for it"
            found.append(Problem("workers of this machine and a scheduler do not go together", "workers", why))
        return found
