"""mmweaver generate --texts: many sequences in one room, which is read once; a folder for each.

Unless --draws free is given, all sentences have the same places, headings, people and lengths (matched draws).
"""

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
    from mmweaver.activity_sets.paired_sampling import Draw, GivenPlacing
    from mmweaver.generate import Weaver
    from mmweaver.generation import Room
    from mmweaver.request import Request

LIST, LEAKS = "sequences.json", "leaks.json"
MAX_TEXTS_BYTES = 16 * 2**20
MOST = 100_000  # sequences
FOR_ONE_SEQUENCE = ("text", "motion", "motion_model", "path")


@dataclass(frozen=True, kw_only=True)
class BatchSequence:
    """One sequence of a batch."""

    folder: Path
    text: str
    seed: int
    draw: "Draw | None" = None  # place, heading and person, where they are not chosen by the planner
    height_m: float | None = None

    def entry(self) -> dict[str, Any]:
        """What the list of all sequences says of it."""
        entry: dict[str, Any] = {"folder": self.folder.name, "text": self.text, "seed": self.seed}
        if self.draw is None:
            return entry
        return entry | {
            "draw": self.draw.index, "at": list(self.draw.start_m), "heading_deg": self.heading_deg,
            "subject": self.draw.subject,
        }  # fmt: skip

    @property
    def heading_deg(self) -> float | None:
        """The heading as --heading takes it."""
        from mmweaver.activity_sets.paired_sampling import heading_deg

        return None if self.draw is None else heading_deg(self.draw)

    def placing(self) -> dict[str, Any]:
        """The options of `mmweaver generate` that give it its place and person."""
        if self.draw is None:
            return {}
        return {
            "at": [self.draw.start_m], "heading": self.heading_deg, "subject": [self.draw.subject],
            "height": None if self.height_m is None else [self.height_m],
        }  # fmt: skip


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

    def run(self, sequences: list[BatchSequence], refused: list[dict[str, Any]] | None = None) -> dict[str, Any]:
        """Generates the missing sequences and returns a summary of all of them; `refused` begins the list of those.

        A sentence for which the room has no place is skipped and listed as such. Raises InputError where nothing could
        be generated, or, before anything is, where a folder holds something else.
        """
        from mmweaver.core.atomic_files import atomic_file

        out = sequences[0].folder.parent
        finished = set() if self.overwrite else {one.folder for one in sequences if self._is_finished(one)}
        made: list[dict[str, Any]] = []
        refused = list(refused or [])
        try:
            self._run_each(sequences, finished, made, refused)
        except KeyboardInterrupt:
            kept = f"{len(made)} of {len(sequences)} sequences are finished in {out}"
            raise KeyboardInterrupt(f"{kept}; the same command makes the rest" if made else "") from None
        if not made:
            raise InputError(f"none of {len(sequences)} sequences could be made; the first: {refused[0]['why']}")
        summary: dict[str, Any] = {"out": str(out), "sequences": made, "refused": refused}
        leaks = self._leaks(sequences)
        if leaks is not None:
            summary["leaks"] = leaks["verdict"]
            with atomic_file(out / LEAKS) as partial:
                partial.write_text(json.dumps(leaks, indent=1) + "\n", encoding="utf-8")
        with atomic_file(out / LIST) as partial:
            partial.write_text(json.dumps(summary, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        return summary

    def _leaks(self, sequences: list[BatchSequence]) -> dict[str, Any] | None:
        """The leak report of matched draws of several sentences."""
        draws = [one.draw for one in sequences if one.draw is not None]
        texts = sorted({one.text for one in sequences})
        if len(draws) < len(sequences) or len(texts) < 2 or len({draw.index for draw in draws}) < 2:
            return None
        from mmweaver.activity_sets.paired_sampling import folder_leaks

        folders, requests = [one.folder for one in sequences], [self.requests[text] for text in texts]
        return folder_leaks(folders, [one.text for one in sequences], draws, requests)

    def request(self, one: BatchSequence) -> "Request":
        """The request of one sequence."""
        own = self.requests[one.text]
        if one.draw is None:
            return replace(own, seed=one.seed)
        from mmweaver.activity_sets.paired_sampling import placed

        return placed(own, one.draw, one.height_m)

    def _run_each(
        self, sequences: list[BatchSequence], finished: set[Path], made: list[Any], refused: list[Any]
    ) -> None:
        from tqdm import tqdm

        for one in tqdm(sequences, unit="sequence", delay=2, disable=self.quiet or None):
            entry = one.entry()
            try:
                if one.folder not in finished:
                    self._generate(one)
            except _NoPlaceError as error:
                refused.append({**entry, "why": str(error)})
                continue
            made.append(entry)

    def _generate(self, one: BatchSequence) -> None:
        try:
            result = self.weaver.carry_out(self.request(one), self.room)
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
            request = self.request(one)
            expected = {**self._expected_meta(request), "text": one.text, "seed": one.seed}
            expected["at"] = None if request.at is None else list(request.at)
            is_same = self._expected_files() <= set(found["files"])
            is_same = is_same and all(found[name] == value for name, value in expected.items())
            placing = {"heading_rad": request.heading_rad, "height_m": request.height_m, "subject": request.subject}
            is_same = is_same and all(found["placed"][name] == value for name, value in placing.items())
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


def checked_texts(arguments: argparse.Namespace) -> list[str]:
    """The sentences of --texts. Raises InputError for a bad file, and for options of a single sequence."""
    for name in FOR_ONE_SEQUENCE:
        if getattr(arguments, name) is not None:
            raise InputError(f"--texts makes many sequences; leave out --{name.replace('_', '-')}, or --texts")
    if len(arguments.radar_pose or ()) > 1:
        raise InputError(
            "--texts takes one --radar-pose; run it once for each radar: the same seeds give the same motions"
        )
    for name in ("at", "height", "subject"):
        if len(getattr(arguments, name) or ()) > 1:
            raise InputError(f"--texts makes sequences of one person each; give --{name} once")
    texts = read_texts(arguments.texts)
    if not 1 <= arguments.repeat <= MOST // len(texts):
        raise InputError(f"--repeat must be 1 to {MOST // len(texts)} for {len(texts)} sentences")
    return texts


def given_placing(arguments: argparse.Namespace) -> "GivenPlacing":
    """What the user fixes for all sequences."""
    from mmweaver.activity_sets.paired_sampling import GivenPlacing

    at, height, subject = ((getattr(arguments, name) or [None])[0] for name in ("at", "height", "subject"))
    return GivenPlacing(start_m=at, heading_deg=arguments.heading, height_m=height, subject=subject)


def parse_texts(
    weaver: "Weaver", texts: list[str], settings: dict[str, Any], file: Path, *, equally_long: bool
) -> "dict[str, Request]":
    """The parsed request of each distinct sentence; `equally_long`: all as long as the longest, if no length is given.

    Raises InputError for a sentence that cannot be acted out in the time.
    """
    requests = {}
    for text in dict.fromkeys(texts):
        try:
            requests[text] = weaver.request(text, **settings)
            if not requests[text].people:
                raise InputError("an empty room is no sequence of a person; generate it alone, with --text")
        except InputError as error:
            raise InputError(f"{file}, {text[:60]!r}: {error}") from None
    longest = max(one.frames for one in requests.values())
    if equally_long and any(one.frames < longest for one in requests.values()):
        given = settings | {"frames": longest, "seconds": None}
        return parse_texts(weaver, texts, given, file, equally_long=False)
    return requests


def free_sequences(texts: list[str], arguments: argparse.Namespace, out: Path) -> list[BatchSequence]:
    """All sentences --repeat times, each with its own seed; a larger --repeat continues a smaller one."""
    every = texts * arguments.repeat
    return [
        BatchSequence(folder=out / _name(number, len(every)), text=text, seed=arguments.seed + number)
        for number, text in enumerate(every)
    ]


def matched_sequences(
    texts: list[str], requests: "dict[str, Request]", room: "Room", arguments: argparse.Namespace, out: Path
) -> tuple[list[BatchSequence], list[dict[str, Any]]]:
    """All sentences at --repeat draws, and those that the room has no place for; a larger --repeat continues a smaller.

    Raises InputError where no place serves one of them.
    """
    from mmweaver.activity_sets.paired_sampling import sentence_draws, sentence_order

    given = given_placing(arguments)
    try:
        draws, why = sentence_draws(requests, room.scene, arguments.repeat, arguments.seed, given)
    except InputError as error:
        if given.start_m is not None:  # where it does not serve alone, either
            raise
        raise InputError(f"{error}; or give --draws free, which places each sentence by itself") from None
    made: list[BatchSequence] = []
    refused: list[dict[str, Any]] = []
    count = len(texts) * arguments.repeat
    for number in range(count):
        round_of, within = divmod(number, len(texts))
        text = sentence_order(texts, round_of, arguments.seed)[within]
        if text in why:
            folder = out / _name(number, count)
            refused.append({"folder": folder.name, "text": text, "seed": arguments.seed + round_of, "why": why[text]})
        else:
            draw = draws[round_of][text]
            folder = out / _name(number, count)
            made.append(
                BatchSequence(folder=folder, text=text, seed=draw.seed, draw=draw, height_m=given.height_m)
            )  # fmt: skip
    if not made:
        raise InputError(f"none of {count} sequences could be made; the first: {refused[0]['why']}")
    return made, refused


def _name(number: int, count: int) -> str:
    return f"{number:0{max(4, len(str(count - 1)))}d}"


def summary_text(summary: dict[str, Any]) -> str:
    """The summary for people."""
    count = len(summary["sequences"])
    lines = [f"{count} sequence{'s' if count > 1 else ''} in {summary['out']}, listed in {LIST}"]
    lines += [summary["leaks"]] if "leaks" in summary else []
    lines += [f"skipped {one['folder']}, {one['text']!r}: {one['why']}" for one in summary["refused"]]
    return "\n".join(lines)
