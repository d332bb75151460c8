"""mmweaver generate --texts: many sequences in one room, which is read once; a folder for each."""

import argparse
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.generate import Weaver
    from mmweaver.generation import Room
    from mmweaver.request import Request

LIST = "sequences.json"
MOST = 100_000  # sequences
ONE_MOTION = ("text", "motion", "motion_model", "at", "height")  # of a single sequence


@dataclass(frozen=True, kw_only=True)
class BatchRequest:
    """One sequence to be made."""

    folder: Path
    text: str
    seed: int


def read_texts(file: Path) -> list[str]:
    """Sentences, one a line; empty lines and those that begin with # count for nothing. Raises InputError."""
    try:
        lines = [line.strip() for line in file.read_text(encoding="utf-8").splitlines()]
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{file} cannot be read as text ({error}); give a file with one sentence a line") from None
    texts = [line for line in lines if line and not line.startswith("#")]
    if not texts:
        raise InputError(f"{file} holds no sentence; write one a line")
    return texts


def asked_of(arguments: argparse.Namespace, out: Path) -> list[BatchRequest]:
    """All sentences --repeat times, each with a seed of its own. Raises InputError for what goes with one sequence."""
    for name in ONE_MOTION:
        if getattr(arguments, name) is not None:
            raise InputError(f"--texts makes many sequences; leave out --{name.replace('_', '-')}, or --texts")
    texts = read_texts(arguments.texts)
    if not 1 <= arguments.repeat <= MOST // len(texts):
        raise InputError(f"--repeat must be 1 to {MOST // len(texts)} for {len(texts)} sentences")
    every = texts * arguments.repeat  # so that a larger --repeat goes on where a smaller one ended
    digits = max(4, len(str(len(every) - 1)))
    return [
        BatchRequest(folder=out / f"{number:0{digits}d}", text=text, seed=arguments.seed + number)
        for number, text in enumerate(every)
    ]


def parse_texts(
    weaver: "Weaver", asked: list[BatchRequest], request: dict[str, Any], file: Path
) -> "dict[str, Request]":
    """The parsed request of each distinct sentence. Raises InputError for one that cannot be acted out in the time."""
    requests = {}
    for text in dict.fromkeys(one.text for one in asked):
        try:
            requests[text] = weaver.request(text, **request)
        except InputError as error:
            raise InputError(f"{file}, {text[:60]!r}: {error}") from None
    return requests


def make_many(
    weaver: "Weaver", room: "Room", asked: list[BatchRequest], requests: "dict[str, Request]",
    arguments: argparse.Namespace,
) -> dict[str, Any]:  # fmt: skip
    """Makes what is not there yet and tells what there is; a sentence for which the room has no place is left out.

    Raises InputError where nothing could be made, or, before anything is made, where a folder holds something else.
    """
    from tqdm import tqdm

    from mmweaver.core.atomic_files import atomic_file

    out = asked[0].folder.parent
    wanted = _wanted(weaver, room, next(iter(requests.values())), arguments)
    there = set() if arguments.overwrite else {one.folder for one in asked if _is_there(one, *wanted)}
    made: list[dict[str, Any]] = []
    refused: list[dict[str, Any]] = []
    for one in tqdm(asked, unit="sequence", delay=2, disable=arguments.quiet or None):
        entry: dict[str, Any] = {"folder": one.folder.name, "text": one.text, "seed": one.seed}
        if one.folder in there:
            made.append(entry)
            continue
        try:
            result = weaver.carry_out(replace(requests[one.text], seed=one.seed), room)
        except InputError as error:
            refused.append({**entry, "why": str(error)})
            continue
        result.save(
            one.folder, overwrite=arguments.overwrite, adc_data_bin=arguments.bin, iq_order=arguments.iq_order or "iq",
            pictures=not arguments.no_pictures,
        )  # fmt: skip
        made.append(entry)
    if not made:
        raise InputError(f"none of {len(asked)} sequences could be made; the first: {refused[0]['why']}")
    summary = {"out": str(out), "sequences": made, "refused": refused}
    with atomic_file(out / LIST) as partial:
        partial.write_text(json.dumps(summary, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return summary


def told(summary: dict[str, Any]) -> str:
    """The summary for people."""
    count = len(summary["sequences"])
    lines = [f"{count} sequence{'s' if count > 1 else ''} in {summary['out']}, listed in {LIST}"]
    lines += [f"left out {one['folder']}, {one['text']!r}: {one['why']}" for one in summary["refused"]]
    return "\n".join(lines)


def _wanted(
    weaver: "Weaver", room: "Room", request: "Request", arguments: argparse.Namespace
) -> tuple[dict[str, Any], set[str]]:
    """What meta.json says of all that is asked for, and the files that not every run writes."""
    from mmweaver.methods import DEFAULT_METHOD
    from mmweaver.result_folder import plain, radar_meta

    same = {"frames": request.frames, "points": weaver.points, "weights": weaver.weights, "inputs": room.inputs}
    method = {} if weaver.method_name == DEFAULT_METHOD else {"method": weaver.method_name}
    files = {"adc_data.bin": arguments.bin, "preview.png": not arguments.no_pictures}
    return plain({**same, **method, **radar_meta(request.config)}), {
        name for name, is_asked in files.items() if is_asked
    }


def _is_there(one: BatchRequest, said: dict[str, Any], files: set[str]) -> bool:
    """Whether an earlier run made just this, as its meta.json says. Raises InputError where it made something else."""
    meta = one.folder / "meta.json"
    if not one.folder.exists():
        return False
    try:
        found = json.loads(meta.read_text(encoding="utf-8"))
        wanted = {**said, "text": one.text, "seed": one.seed}
        is_same = files <= set(found["files"]) and all(found[name] == value for name, value in wanted.items())
    except (OSError, ValueError, KeyError, TypeError):
        is_same = False
    if not is_same:
        raise InputError(f"{one.folder} holds something else; choose another --out or allow it with --overwrite")
    return True
