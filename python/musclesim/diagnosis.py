"""The sim-to-real gap: where it arises, which effect causes it, and how much of it that effect removes."""

from __future__ import annotations

import json
import os
from typing import Any, Callable, Iterable, Sequence

from . import _musclesim
from ._musclesim import Recording
from .recording import _as_recording, _checked


class Diagnosis:
    """The answer of diagnose(). str(diagnosis) is a summary.

    data: the contents of diagnosis.json (docs/reference/diagnosis_json.md).  report: a page in HTML.  effects: what was found, as
    Simulation(effects=...), replay(effects=...) and effects files take it; `parameters` belongs to it.
    """

    def __init__(self, answer: dict[str, Any]) -> None:
        self.data: dict[str, Any] = answer["data"]
        self.report: str = answer["report"]
        self.summary: str = answer["summary"]
        self.effects: list[dict[str, Any]] = answer["effects"]
        self._files: dict[str, str] = answer["files"]
        self._made_in: str = os.getcwd()

    @property
    def verdict(self) -> str:
        """ "no_gap", "effects_found", "unexplained" or "not_excited"."""
        return str(self.data["verdict"])

    @property
    def causes(self) -> list[str]:
        """The effects that were found, as "id@component"."""
        return list(self.data.get("chosen", []))

    @property
    def probabilities(self) -> dict[str, float]:
        """Probability of every effect that has at least 0.01, by "id@component"."""
        return {f"{e['id']}@{e['component']}": e["probability"] for e in self.data.get("effects", [])}

    @property
    def parameters(self) -> dict[str, float]:
        """Numbers of the model that were fitted together with `effects`, by name; nominal.toml holds the same. They belong to the answer:
        pass both to Simulation(effects=..., parameters=...) or replay(effects=..., parameters=...). Empty if no number has a tolerance."""
        return {**{n["name"]: n["value_with_effects"] for n in self.data.get("tuned", [])},
                **{n["name"]: n["value"] for n in self.data.get("numbers", [])}}

    def save(self, folder: str | os.PathLike[str]) -> None:
        """Writes the files of `musclesim diagnose` into a folder, which is made if it is missing.

        diagnosis.json, report.html, effects.json; where there is something to write, next.csv with next.json (the proposed commands, a
        recording without readings), attempt.json and nominal.toml. Those of an earlier diagnosis in the folder are removed.
        """
        os.makedirs(folder, exist_ok=True)
        for name in ("attempt.json", "nominal.toml", "next.csv", "next.json"):
            if name not in self._files and os.path.exists(os.path.join(folder, name)):
                os.remove(os.path.join(folder, name))
        found = {"format": "musclesim-effects-1", "effects": self.effects}
        files = dict(self._files)
        if "next.json" in files:
            sidecar = json.loads(files["next.json"])
            if sidecar["robot"].endswith(".toml"):  # named relative to where the diagnosis was made
                sidecar["robot"] = os.path.relpath(os.path.join(self._made_in, sidecar["robot"]), folder)
            files["next.json"] = json.dumps(sidecar, indent=2) + "\n"
        for name, text in (("diagnosis.json", json.dumps(self.data, indent=2)), ("report.html", self.report),
                           ("effects.json", json.dumps(found, indent=2)), *files.items()):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)

    def __str__(self) -> str:
        return self.summary

    def __repr__(self) -> str:
        return f"<musclesim.Diagnosis: {self.verdict}, causes {self.causes}>"


def diagnose(recordings: Recording | str | os.PathLike[str] | Iterable[Recording | str | os.PathLike[str]], *,
             candidates: Sequence[str] = (), exclude: Sequence[str] = (), tune: Sequence[str] = (), smallest_gap_percent: float = 1,
             max_effects: int = 4, threads: int = 0, seed: int = 1, earlier: Any = None, without_active_effects: bool = False,
             trust_columns: bool = False, skip_start_s: float | None = None,
             progress: Callable[[str, int, int], Any] | None = None, **model: Any) -> Diagnosis:
    """Finds from recordings of one plant where they differ from the model and which effects explain it.

    recordings: Recordings or their files.  candidates, exclude: ids of effects to consider (default: the whole catalogue) or not to.
    tune: parameters of the model that nobody measured.  smallest_gap_percent: a gap below this share of the motion in every signal counts
    as none; 0: every gap beyond the noise is looked into.  max_effects: largest number of effects in an explanation, 1..6.  threads: 0: one
    per core; the answer does not depend on it.  earlier: effects of an earlier finding, to begin with.  without_active_effects: compare with
    the model without the effects that the recordings' sidecars say are active, and look for them.  trust_columns: take units, zeros, signs
    and order of the columns as they are instead of refusing doubtful ones.  skip_start_s: readings of this many seconds at the beginning of
    every recording are left out, because the machine had been moving; None: as the sidecars say, and a second of recordings that turn out
    to begin in motion.  progress(phase, done, expected): called a few times a second by the calling thread; an exception that it raises ends
    the diagnosis.  **model: as for replay.
    Raises BadParameter, BadFile, Diverged, KeyboardInterrupt.
    """
    if isinstance(recordings, (Recording, str, os.PathLike)):
        recordings = [recordings]
    return Diagnosis(_musclesim._diagnose([_as_recording(one) for one in recordings], _checked(model), list(candidates), list(exclude),
                                          list(tune), smallest_gap_percent, max_effects, threads, seed, earlier, without_active_effects,
                                          trust_columns, skip_start_s, progress))
