"""A job: one command on the trials of one ship and date, as a document that says all the result depends on."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, Self

SCHEMA = 1


@dataclass(frozen=True)
class Source:
    """Files that a job reads: a path or URL, and for each file in it what tells its content from another."""

    path: str
    files: Mapping[str, str]


@dataclass(frozen=True)
class Job:
    """A job; made from the same it gives the same, on whatever machine.

    ship, date, name  tell it from the others
    sisters   the class the ship is pooled with, "" for none
    profile   text of the profile; profile_path is where it was read, for records
    options   as JSON has them
    version   of the program: another one is another job
    """

    ship: str
    date: str
    name: str
    command: str
    profile: str
    profile_path: str
    trials: Source
    options: Mapping[str, Any]
    version: str
    sisters: str = ""
    baseline: Source | None = None

    @cached_property
    def key(self) -> str:
        """A hash of all the result depends on: contents, not where they lie."""
        document = self.to_dict()
        document["profile_path"] = ""
        document["trials"] = self.trials.files
        document["baseline"] = sorted(self.baseline.files.values()) if self.baseline else None
        text = json.dumps(document, sort_keys=True, ensure_ascii=False)
        return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:16]

    @property
    def place(self) -> str:
        """Its run folder inside that of the fleet."""
        return f"runs/{self.ship}/{self.date}/{self.name}"

    @property
    def label(self) -> str:
        """For messages."""
        return f"{self.ship} {self.date} {self.name}"

    def to_dict(self) -> dict[str, Any]:
        """The document."""
        return {"schema": SCHEMA, "kind": "fleet-job", **asdict(self)}

    @classmethod
    def from_dict(cls, document: Mapping[str, Any]) -> Self:
        """The job of a document."""
        known = {key: value for key, value in document.items() if key not in ("schema", "kind")}
        trials, baseline = Source(**known.pop("trials")), known.pop("baseline")
        return cls(**known, trials=trials, baseline=Source(**baseline) if baseline else None)
