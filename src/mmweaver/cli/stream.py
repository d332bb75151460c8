"""mmweaver generate --stream: one sentence after the other without a break, written part by part."""

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.cli.generate import Options

PART_FRAMES = 20  # maximum loss if the process is killed
OF_SENTENCE = ("text", "refused", "plan", "clauses")
STANDARD_INPUT = "-"
NOT_OF_STREAMS = {
    "motion_file": "motion",
    "motion_model": "motion-model",
    "path_m": "path",
    "seconds": "seconds",
    "radar_poses": "radar-pose",
    "per_class": "per-class",
}


def run_stream(asked: "Options", out: Path) -> int:
    """Writes the stream until sentences end, --frames are reached or Ctrl+C.

    Args:
        asked: Options of the command.
        out: Folder of the stream.

    Returns:
        Exit status.

    Raises:
        InputError: For options that streams do not support, or a first sentence that cannot be carried out.
    """
    from mmweaver.cli.generate_inputs import radar_of, read_background, room_of, weaver_of
    from mmweaver.core.atomic_files import claimed_folder
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.io.result_folder import META_VERSION, radar_meta
    from mmweaver.io.stream_folder import StreamFolder

    _check(asked)
    person = asked.of_one_person("--stream is of one person")
    check_output_folder(out, overwrite=True, inputs=asked.inputs)
    _check_free(out)
    background = read_background(asked)
    weaver = weaver_of(asked, radar_of(asked, background))
    room = room_of(asked, weaver, background)
    limit = asked.frames
    folder: StreamFolder | None = None
    interrupted = False
    chunks = weaver.stream(
        room,
        _sentences(asked),
        seed=asked.seed,
        fps=asked.fps,
        keep_adc=asked.keep_adc,
        board=asked.board_name(),
        chunk_frames=PART_FRAMES if limit is None else min(PART_FRAMES, limit),
        heading_rad=asked.heading_rad,
        missing=asked.missing,
        parser=asked.parser,
        strict=asked.strict,
        **person,
    )
    with claimed_folder(out):
        _check_free(out)
        try:
            for chunk in chunks:
                if folder is None:
                    shared = {name: chunk.meta[name] for name in chunk.meta if name not in OF_SENTENCE}
                    meta = {"schema_version": META_VERSION, "made_by": "mmweaver generate --stream", **shared}
                    meta |= radar_meta(chunk.cube.config)
                    folder = StreamFolder(out, meta, iq_order=asked.iq_order)
                if chunk.refused:
                    print(f"skipped: {chunk.refused}", file=sys.stderr)
                left = chunk.num_frames if limit is None else min(limit - folder.frames, chunk.num_frames)
                chunk = chunk if left == chunk.num_frames else chunk.first(left)
                sentence = {name: chunk.meta[name] for name in ("text", "refused", "clauses", "assumed")}
                folder.add(chunk.cube, chunk.points, chunk.poses, chunk.adc, sentence)
                if limit is not None and folder.frames >= limit:
                    break
        except KeyboardInterrupt:
            if folder is None or not folder.parts:
                raise
            interrupted = True
        if folder is None:
            raise InputError("there is no sentence; give at least one")
        meta = folder.finish()
    if interrupted:
        raise KeyboardInterrupt(f"{folder.frames} frames are in {out}")
    summary = {"out": str(out), "frames": meta["frames"], "parts": meta["parts"]}
    return asked.report(summary, f"wrote {out}: {meta['frames']} frames in {meta['parts']} parts")


def _check_free(out: Path) -> None:
    """Rejects a folder that holds a stream or anything else, after removing leftovers of killed processes."""
    from mmweaver.core.output_checks import is_empty
    from mmweaver.core.staging import is_own_folder, sweep
    from mmweaver.io.stream_folder import LIST, PARTS

    if is_own_folder(out / PARTS):
        sweep(out / PARTS)
    if (out / LIST).is_file():
        raise InputError(
            f"{out} holds a stream already, and streams cannot be continued; choose another --out, or delete that"
            " folder (`mmweaver verify` checks and `mmweaver compress` reads what it holds, even after an interruption)"
        )
    if out.is_dir() and not is_empty(out):
        raise InputError(f"{out} is not empty; a stream needs a folder of its own: choose another --out")


def _check(asked: "Options") -> None:
    """Checks the options; InputError for those that streams do not support, or without a sentence."""
    for name, option in NOT_OF_STREAMS.items():
        if getattr(asked, name):
            raise InputError(f"--stream takes sentences; leave out --{option}, or --stream")
    if (asked.text is None) == (asked.texts is None):
        raise InputError("--stream needs sentences: --text for each, --texts FILE, or --texts - for standard input")


def _sentences(asked: "Options") -> Iterable[str]:
    """The sentences, from the command line, a file, or live from standard input."""
    from mmweaver.cli.batch import read_texts
    from mmweaver.io.stream_folder import sentences_of

    if asked.texts is None:
        return asked.text or ()
    return sentences_of(sys.stdin) if str(asked.texts) == STANDARD_INPUT else read_texts(asked.texts)
