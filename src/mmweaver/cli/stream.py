"""mmweaver generate --stream: one sentence after the other without a break, written part by part."""

import argparse
import math
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.generate import Weaver
    from mmweaver.generation import Room

PART_FRAMES = 20  # what a kill may lose
STANDARD_INPUT = "-"
NOT_OF_STREAMS = ("motion", "motion_model", "path", "html", "seconds", "radar_pose")


def check_stream_options(arguments: argparse.Namespace) -> None:
    """Raises InputError for options that streams do not have, or where nothing is said."""
    for name in NOT_OF_STREAMS:
        if getattr(arguments, name, None) is not None:
            raise InputError(f"--stream takes sentences; leave out --{name.replace('_', '-')}, or --stream")
    for name in ("at", "height", "subject"):
        if len(getattr(arguments, name, None) or ()) > 1:
            raise InputError(f"--stream is of one person; give --{name} once")
    if arguments.repeat != 1:
        raise InputError("--stream says every sentence once; leave out --repeat")
    if (arguments.text is None) == (arguments.texts is None):
        raise InputError("--stream needs sentences: --text for each, --texts FILE, or --texts - for standard input")


def sentences(arguments: argparse.Namespace) -> Iterable[str]:
    """The sentences, from the command line, a file, or standard input as they come."""
    from mmweaver.cli.batch import read_texts
    from mmweaver.stream_folder import sentences_of

    if arguments.text is not None:
        return arguments.text
    return sentences_of(sys.stdin) if str(arguments.texts) == STANDARD_INPUT else read_texts(arguments.texts)


def run_stream(
    arguments: argparse.Namespace, weaver: "Weaver", room: "Room", out: Path, board: str | None
) -> dict[str, Any]:
    """Writes the stream into `out` until sentences end, --frames are reached or Ctrl+C; returns meta.json."""
    from mmweaver.result_folder import META_VERSION, radar_meta
    from mmweaver.stream_folder import StreamFolder

    heading = None if arguments.heading is None else math.radians(arguments.heading) - math.pi / 2
    placing = {
        "at": _only(arguments.at), "heading_rad": heading,
        "height_m": _only(arguments.height), "subject": _only(arguments.subject),
    }  # fmt: skip
    most = arguments.frames
    folder: StreamFolder | None = None
    interrupted = False
    chunks = weaver.stream(
        room, sentences(arguments), seed=arguments.seed, fps=arguments.fps, keep_adc=arguments.bin, board=board,
        chunk_frames=PART_FRAMES if most is None else min(PART_FRAMES, most), **placing,
    )  # fmt: skip
    try:
        for chunk in chunks:
            if folder is None:
                meta = {
                    "schema_version": META_VERSION, "made_by": "mmweaver generate --stream", **chunk.meta,
                    **radar_meta(chunk.cube.config),
                }  # fmt: skip
                for of_sentence in ("text", "refused", "plan", "clauses"):
                    meta.pop(of_sentence, None)
                folder = StreamFolder(out, meta, iq_order=arguments.iq_order)
            if chunk.refused:
                print(f"skipped: {chunk.refused}", file=sys.stderr)
            left = chunk.num_frames if most is None else min(most - folder.frames, chunk.num_frames)
            chunk = chunk if left == chunk.num_frames else chunk.first(left)
            said = {name: chunk.meta[name] for name in ("text", "refused", "clauses", "assumed")}
            folder.add(chunk.cube, chunk.points, chunk.poses, chunk.adc, said)
            if most is not None and folder.frames >= most:
                break
    except KeyboardInterrupt:
        interrupted = True
    if folder is None:
        raise InputError("nothing was said; give at least one sentence")
    meta = folder.finish()
    if interrupted:
        raise KeyboardInterrupt(f"{folder.frames} frames are in {out}")
    return meta


def _only(values: Any) -> Any:
    return values[0] if isinstance(values, list) and values else values
