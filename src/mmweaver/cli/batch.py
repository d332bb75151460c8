"""mmweaver generate --texts: many sequences in one room, which is read once; a folder for each.

All sentences have the same places, headings, people and lengths (matched draws).
"""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import REQUEST_FILE
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_json, read_text

if TYPE_CHECKING:
    from mmweaver.cli.generate import Options
    from mmweaver.datasets.paired_sampling import Draw, GivenPlacing
    from mmweaver.weaver.front_door import Weaver
    from mmweaver.weaver.generation import Room
    from mmweaver.weaver.parsed_request import ParsedRequest

LIST, LEAKS = "sequences.json", "leaks.json"
MAX_TEXTS_BYTES = 16 * 2**20
MAX_SEQUENCES = 100_000
FOR_ONE_SEQUENCE = {"text": "text", "motion_file": "motion", "motion_model": "motion-model", "path_m": "path"}


@dataclass(frozen=True, kw_only=True)
class BatchSequence:
    """One sequence of a batch."""

    folder: Path
    text: str
    draw: "Draw"  # place, heading, person and seed
    height_m: float | None

    @property
    def seed(self) -> int:
        return self.draw.seed

    def entry(self) -> dict[str, Any]:
        """What the list of all sequences holds of it."""
        from mmweaver.datasets.paired_sampling import heading_deg

        return {
            "folder": self.folder.name,
            "text": self.text,
            "seed": self.seed,
            "draw": self.draw.index,
            "at": list(self.draw.start_m),
            "heading_deg": heading_deg(self.draw),
            "subject": self.draw.subject,
        }

    def options(self) -> dict[str, Any]:
        """The options of `mmweaver generate` that make it alone."""
        from mmweaver.weaver.request import Heading

        return {
            "text": [self.text],
            "texts": None,
            "per_class": None,
            "seed": self.seed,
            "seconds": None,
            "at": [self.draw.start_m],
            "heading_rad": Heading(self.draw.heading_rad),
            "subject": [self.draw.subject],
            "height_m": None if self.height_m is None else [self.height_m],
        }


@dataclass(frozen=True, kw_only=True)
class Batch:
    """What all sequences of a batch share."""

    asked: "Options"
    weaver: "Weaver"
    room: "Room"
    requests: "dict[str, ParsedRequest]"  # by text; place, person and seed are each sequence's own

    def run(self, sequences: list[BatchSequence], refused: list[dict[str, Any]]) -> dict[str, Any]:
        """Generates the missing sequences and returns a summary of all of them; `refused` begins the list of those.

        A sentence for which the room has no place is skipped and listed as such. Raises InputError where nothing could
        be generated, or, before anything is, where a folder holds something else.
        """
        from tqdm import tqdm

        from mmweaver.core.atomic_files import atomic_file

        out, asked = sequences[0].folder.parent, self.asked
        finished = set() if asked.overwrite else {one.folder for one in sequences if self._is_finished(one)}
        made: list[dict[str, Any]] = []
        try:
            for one in tqdm(sequences, unit="sequence", delay=2, disable=asked.quiet or None):
                try:
                    if one.folder not in finished:
                        self._generate(one)
                    made.append({**one.entry(), **_outcome(one.folder)})
                except _NoPlaceError as error:
                    refused.append({**one.entry(), "why": str(error)})
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
        """The leak report of several draws of several sentences."""
        from mmweaver.datasets.paired_sampling import folder_leaks

        draws, texts = [one.draw for one in sequences], sorted({one.text for one in sequences})
        if len(texts) < 2 or len({draw.index for draw in draws}) < 2:
            return None
        requests = [self.requests[text] for text in texts]
        return folder_leaks([one.folder for one in sequences], [one.text for one in sequences], draws, requests)

    def request(self, one: BatchSequence) -> "ParsedRequest":
        """The request of one sequence."""
        from mmweaver.datasets.paired_sampling import placed

        return placed(self.requests[one.text], one.draw, one.height_m)

    def _generate(self, one: BatchSequence) -> None:
        request = self.request(one)
        try:
            result = self.weaver.carry_out(request, self.room)
        except InputError as error:
            raise _NoPlaceError(str(error)) from None
        # only a damaged folder of the same sequence is there without --overwrite
        overwrite = self.asked.overwrite or one.folder.exists()
        extra = {REQUEST_FILE: self.asked.request_toml(frames=request.frames, **one.options())}
        result.save(one.folder, overwrite=overwrite, extra=extra, **self.asked.output)

    def _is_finished(self, one: BatchSequence) -> bool:
        """Whether an earlier run made this sequence and it is undamaged. Raises InputError where it made another."""
        from mmweaver.core.checksums import damages
        from mmweaver.core.output_checks import check_output_folder, is_empty

        check_output_folder(one.folder, overwrite=True, files=("radar.npz", "meta.json"))
        if not one.folder.exists() or is_empty(one.folder):
            return False
        request = self.request(one)
        wanted = {"adc_data.bin": self.asked.keep_adc, "preview.png": not self.asked.no_pictures}
        try:
            found = read_json(one.folder / "meta.json")
            is_same = {name for name, is_wanted in wanted.items() if is_wanted} <= set(found["files"])
            is_same = is_same and all(found[name] == value for name, value in self._expected(one, request).items())
        except (InputError, KeyError, TypeError):
            is_same = False
        if not is_same:
            raise InputError(f"{one.folder} holds something else; choose another --out or allow it with --overwrite")
        return not damages(one.folder)

    def _expected(self, one: BatchSequence, request: "ParsedRequest") -> dict[str, Any]:
        """What meta.json of the same sequence holds."""
        from mmweaver.io.result_folder import plain
        from mmweaver.models.methods import DEFAULT_METHOD

        weaver = self.weaver
        same = {"weights": weaver.weights, "inputs": self.room.inputs, "points": weaver.points, "text": one.text}
        same["board"] = weaver.board_of(request, self.room)[0].meta()
        if weaver.method_name != DEFAULT_METHOD:
            same["method"] = weaver.method_name
        if request.radar_poses:
            same["radar_pose"] = request.radar_poses[0]
        return plain(same | request.meta())


def _outcome(folder: Path) -> dict[str, Any]:
    """What the list of all sequences holds of the clauses that are not done as the sentence says."""
    clauses = read_json(folder / "meta.json").get("clauses", [])
    others = [f"{one['clause']!r} is {one['status']}: {one['how']}" for one in clauses if one["status"] != "done"]
    return {"not_as_said": others} if others else {}


def approximated_lines(made: list[dict[str, Any]]) -> list[str]:
    """One line per sentence of which some sequences do not show all as it says.

    Args:
        made: Entries of the sequences in the list.
    """
    lines = []
    for text in dict.fromkeys(one["text"] for one in made):
        own = [one for one in made if one["text"] == text]
        others = [one["not_as_said"] for one in own if "not_as_said" in one]
        if others:
            lines.append(f"approximated {text!r} in {len(others)} of {len(own)}: {'; '.join(others[0])}")
    return lines


class _NoPlaceError(Exception):
    """The room has no place for a sentence."""


def run_batch(asked: "Options", out: Path) -> int:
    """Makes what is missing of the sequences and prints which there are. Raises InputError."""
    from mmweaver.cli.generate_inputs import radar_of, read_background, room_of, weaver_of
    from mmweaver.core.atomic_files import claimed_folder
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.datasets.paired_sampling import GivenPlacing

    check_output_folder(out, overwrite=True, files=[LIST, LEAKS], inputs=asked.inputs)
    person = asked.of_one_person("--texts makes sequences of one person each")
    texts = _checked_texts(asked)
    background = read_background(asked)
    weaver = weaver_of(asked, radar_of(asked, background))
    requests = _parsed(asked, weaver, texts)
    room = room_of(asked, weaver, background)
    heading = None if asked.heading_rad is None else round(math.degrees(asked.heading_rad) + 90, 10)
    given = GivenPlacing(
        start_m=person["at"], heading_deg=heading, height_m=person["height_m"], subject=person["subject"]
    )
    sequences, refused = _sequences(asked, texts, requests, room, out, given)
    with claimed_folder(out):
        summary = Batch(asked=asked, weaver=weaver, room=room, requests=requests).run(sequences, refused)
    count = len(summary["sequences"])
    lines = [f"{count} sequence{'s' if count > 1 else ''} in {out}, listed in {LIST}"]
    lines += [summary["leaks"]] if "leaks" in summary else []
    lines += approximated_lines(summary["sequences"])
    return asked.report(
        summary, *lines, *(f"skipped {one['folder']}, {one['text']!r}: {one['why']}" for one in refused)
    )


def read_texts(file: Path) -> list[str]:
    """Sentences, one per line; empty lines and those that begin with # are skipped. Raises InputError."""
    lines = [line.strip() for line in read_text(file, max_bytes=MAX_TEXTS_BYTES).splitlines()]
    texts = [line for line in lines if line and not line.startswith("#")]
    if not texts:
        raise InputError(f"{file} holds no sentence; write one per line")
    return texts


def _checked_texts(asked: "Options") -> list[str]:
    """The sentences of --texts. Raises InputError for a bad file, and for options of a single sequence."""
    for name, option in FOR_ONE_SEQUENCE.items():
        if getattr(asked, name) is not None:
            raise InputError(f"--texts makes many sequences; leave out --{option}, or --texts")
    if len(asked.radar_poses) > 1:
        raise InputError(
            "--texts takes one --radar-pose; run it once for each radar: the same seeds give the same motions"
        )
    assert asked.texts is not None
    texts = read_texts(asked.texts)
    if not 1 <= _repeat(asked) <= MAX_SEQUENCES // len(texts):
        most = max(MAX_SEQUENCES // len(texts), 0)
        advice = f"--per-class must be 1 to {most}" if most else "write fewer sentences"
        raise InputError(f"{asked.texts} has {len(texts)} sentences, of which {MAX_SEQUENCES:,} are made: {advice}")
    return texts


def _repeat(asked: "Options") -> int:
    return 1 if asked.per_class is None else asked.per_class


def _parsed(asked: "Options", weaver: "Weaver", texts: list[str], **length: Any) -> "dict[str, ParsedRequest]":
    """The parsed request of each distinct sentence, all as long as the longest if no length is given.

    Raises InputError for a sentence that cannot be acted out in the time.
    """
    requests = {}
    for text in dict.fromkeys(texts):
        one = asked.asked(text=text, at=None, heading_rad=None, height_m=None, subject=None, **length)
        try:
            requests[text] = weaver.parsed(one)
            if not requests[text].people:
                raise InputError("an empty room is no sequence of a person; generate it alone, with --text")
        except InputError as error:
            raise InputError(f"{asked.texts}, {text[:60]!r}: {error}") from None
    longest = max(one.frames for one in requests.values())
    if any(one.frames < longest for one in requests.values()):
        return _parsed(asked, weaver, texts, frames=longest, seconds=None)
    return requests


def _sequences(
    asked: "Options",
    texts: list[str],
    requests: "dict[str, ParsedRequest]",
    room: "Room",
    out: Path,
    given: "GivenPlacing",
) -> tuple[list[BatchSequence], list[dict[str, Any]]]:
    """All sentences --per-class times, and those that the room has no place for; more of each continue fewer.

    Raises InputError where no place serves one of them.
    """
    from mmweaver.datasets.paired_sampling import sentence_draws, sentence_order

    repeat, seed = _repeat(asked), asked.seed
    draws, why = sentence_draws(requests, room.scene, repeat, seed, given)
    made: list[BatchSequence] = []
    refused: list[dict[str, Any]] = []
    count = len(texts) * repeat
    for number in range(count):
        round_of, within = divmod(number, len(texts))
        text = sentence_order(texts, round_of, seed)[within]
        folder = out / f"{number:0{max(4, len(str(count - 1)))}d}"
        if text in why:
            refused.append({"folder": folder.name, "text": text, "seed": seed + round_of, "why": why[text]})
        else:
            made.append(BatchSequence(folder=folder, text=text, draw=draws[round_of][text], height_m=given.height_m))
    if not made:
        raise InputError(f"none of {count} sequences could be made; the first: {refused[0]['why']}")
    return made, refused
