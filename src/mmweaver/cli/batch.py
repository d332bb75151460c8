"""mmweaver generate --texts: many sequences in one room, which is read once; a folder for each."""

import argparse
import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.config_file import REQUEST_FILE
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_json, read_text

if TYPE_CHECKING:
    from mmweaver.generate import Weaver
    from mmweaver.generation import Room
    from mmweaver.request import Request

LIST = "sequences.json"
MAX_TEXTS_BYTES = 16 * 2**20
MOST = 100_000  # sequences
FOR_ONE_SEQUENCE = ("text", "motion", "motion_model", "at", "height", "subject", "path")


@dataclass(frozen=True, kw_only=True)
class BatchSequence:
    """One sequence of a batch."""

    folder: Path
    text: str
    seed: int


@dataclass(frozen=True, kw_only=True)
class Batch:
    """What all sequences of a batch share."""

    weaver: "Weaver"
    room: "Room"
    requests: "dict[str, Request]"  # by text; the seed is each sequence's own
    output: dict[str, Any]  # arguments of Generation.save
    request_toml: Callable[[BatchSequence], str]
    overwrite: bool
    quiet: bool

    def run(self, sequences: list[BatchSequence]) -> dict[str, Any]:
        """Generates the missing sequences and returns a summary of all of them.

        A sentence for which the room has no place is skipped and listed as such. Raises InputError where nothing could
        be generated, or, before anything is, where a folder holds something else.
        """
        from mmweaver.core.atomic_files import atomic_file

        out = sequences[0].folder.parent
        finished = set() if self.overwrite else {one.folder for one in sequences if self._is_finished(one)}
        made: list[dict[str, Any]] = []
        refused: list[dict[str, Any]] = []
        try:
            self._run_each(sequences, finished, made, refused)
        except KeyboardInterrupt:
            kept = f"{len(made)} of {len(sequences)} sequences are finished in {out}"
            raise KeyboardInterrupt(f"{kept}; the same command makes the rest" if made else "") from None
        if not made:
            raise InputError(f"none of {len(sequences)} sequences could be made; the first: {refused[0]['why']}")
        summary = {"out": str(out), "sequences": made, "refused": refused}
        with atomic_file(out / LIST) as partial:
            partial.write_text(json.dumps(summary, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        return summary

    def _run_each(
        self, sequences: list[BatchSequence], finished: set[Path], made: list[Any], refused: list[Any]
    ) -> None:
        from tqdm import tqdm

        for one in tqdm(sequences, unit="sequence", delay=2, disable=self.quiet or None):
            entry: dict[str, Any] = {"folder": one.folder.name, "text": one.text, "seed": one.seed}
            try:
                if one.folder not in finished:
                    self._generate(one)
            except _NoPlaceError as error:
                refused.append({**entry, "why": str(error)})
                continue
            made.append(entry)

    def _generate(self, one: BatchSequence) -> None:
        try:
            result = self.weaver.carry_out(replace(self.requests[one.text], seed=one.seed), self.room)
        except InputError as error:
            raise _NoPlaceError(str(error)) from None
        # only a damaged folder of the same sequence is there without --overwrite
        overwrite = self.overwrite or one.folder.exists()
        result.save(one.folder, overwrite=overwrite, extra={REQUEST_FILE: self.request_toml(one)}, **self.output)

    def _is_finished(self, one: BatchSequence) -> bool:
        """Whether an earlier run made this sequence and it is undamaged. Raises InputError where it made another."""
        from mmweaver.core.checksums import damages
        from mmweaver.core.output_checks import check_output_folder, is_empty

        check_output_folder(one.folder, overwrite=True, files=("radar.npz", "meta.json"))
        if not one.folder.exists() or is_empty(one.folder):
            return False
        try:
            found = read_json(one.folder / "meta.json")
            expected = {**self._expected_meta(self.requests[one.text]), "text": one.text, "seed": one.seed}
            is_same = self._expected_files() <= set(found["files"])
            is_same = is_same and all(found[name] == value for name, value in expected.items())
        except (InputError, KeyError, TypeError):
            is_same = False
        if not is_same:
            raise InputError(f"{one.folder} holds something else; choose another --out or allow it with --overwrite")
        return not damages(one.folder)

    def _expected_meta(self, request: "Request") -> dict[str, Any]:
        from mmweaver.methods import DEFAULT_METHOD
        from mmweaver.result_folder import plain, radar_meta

        weaver = self.weaver
        board = weaver.board_of(request, self.room)[0]
        same = {
            "frames": request.frames, "points": weaver.points, "weights": weaver.weights, "inputs": self.room.inputs,
            "board": board.meta(),
        }  # fmt: skip
        method: dict[str, Any] = {} if weaver.method_name == DEFAULT_METHOD else {"method": weaver.method_name}
        method |= {"radar_pose": request.radar_poses[0]} if request.radar_poses else {}
        return plain({**same, **method, **radar_meta(request.config)})

    def _expected_files(self) -> set[str]:
        files = {"adc_data.bin": self.output["adc_data_bin"], "preview.png": self.output["pictures"]}
        return {name for name, is_wanted in files.items() if is_wanted}


class _NoPlaceError(Exception):
    """The room has no place for a sentence."""


def read_texts(file: Path) -> list[str]:
    """Sentences, one a line; empty lines and those that begin with # are skipped. Raises InputError."""
    lines = [line.strip() for line in read_text(file, max_bytes=MAX_TEXTS_BYTES).splitlines()]
    texts = [line for line in lines if line and not line.startswith("#")]
    if not texts:
        raise InputError(f"{file} holds no sentence; write one a line")
    return texts


def sequences_of(arguments: argparse.Namespace, out: Path) -> list[BatchSequence]:
    """All sentences --repeat times, each with its own seed. Raises InputError for options of a single sequence."""
    for name in FOR_ONE_SEQUENCE:
        if getattr(arguments, name) is not None:
            raise InputError(f"--texts makes many sequences; leave out --{name.replace('_', '-')}, or --texts")
    if len(arguments.radar_pose or ()) > 1:
        raise InputError(
            "--texts takes one --radar-pose; run it once for each radar: the same seeds give the same motions"
        )
    texts = read_texts(arguments.texts)
    if not 1 <= arguments.repeat <= MOST // len(texts):
        raise InputError(f"--repeat must be 1 to {MOST // len(texts)} for {len(texts)} sentences")
    every = texts * arguments.repeat  # in this order, so that a larger --repeat continues a smaller one
    digits = max(4, len(str(len(every) - 1)))
    return [
        BatchSequence(folder=out / f"{number:0{digits}d}", text=text, seed=arguments.seed + number)
        for number, text in enumerate(every)
    ]


def parse_texts(
    weaver: "Weaver", sequences: list[BatchSequence], settings: dict[str, Any], file: Path
) -> "dict[str, Request]":
    """The parsed request of each distinct sentence. Raises InputError for one that cannot be acted out in the time."""
    requests = {}
    for text in dict.fromkeys(one.text for one in sequences):
        try:
            requests[text] = weaver.request(text, **settings)
        except InputError as error:
            raise InputError(f"{file}, {text[:60]!r}: {error}") from None
    return requests


def summary_text(summary: dict[str, Any]) -> str:
    """The summary for people."""
    count = len(summary["sequences"])
    lines = [f"{count} sequence{'s' if count > 1 else ''} in {summary['out']}, listed in {LIST}"]
    lines += [f"skipped {one['folder']}, {one['text']!r}: {one['why']}" for one in summary["refused"]]
    return "\n".join(lines)
