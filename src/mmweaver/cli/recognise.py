"""mmweaver recognise: a recogniser of activities, trained on generated data alone, scored and used."""

import sys
from pathlib import Path
from typing import Any, Literal

from mmweaver.cli.arguments import check_mode
from mmweaver.cli.option_groups import Printed
from mmweaver.cli.progress import StageBar
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver recognise train examples/tasks/radhar.toml --out model/
  mmweaver recognise train TASK.toml --recordings few_recordings/ --out model/
  mmweaver recognise score model/ --recordings recordings/ --json
  mmweaver recognise run model/ --points log.dat
  cat /dev/ttyUSB1 | mmweaver recognise run model/ --points - --json

TASK.toml names the radar, the activities in sentences, and how recordings are stored: docs/recognise.md. Recordings
lie in folders named by activity: .npz with frame and pts, TI .dat, or whatever mmweaver points reads. A pipe brings
the bytes of a TI demo's data port, or CSV lines: Frame,X,Y,Z,Doppler.
"""
STDIN = "-"


@options
class Options(Printed):
    """Trains a recogniser of activities from a page of text, without any recording; scores it on labelled recordings;
    labels point clouds from a file or a pipe.
    """

    action: Literal["train", "score", "run"] = option(
        "train a recogniser, score it on labelled recordings, or run it on a point cloud",
        default=MISSING,
        positional=True,
    )
    place: Path = option(
        "train: the task; else the trained folder", "TASK.toml|MODEL", default=MISSING, positional=True
    )
    out: Any = option("train: folder of the recogniser; the same command resumes it", "DIR", kind=Path)
    sequences: int | None = option(
        "people that perform each activity (default 40, of gestures that are done once 100; 8 are a first look)", "N"
    )
    seed: int = option("seed of people, rooms and trees", "N", default=0)
    recordings: Any = option(
        "labelled recordings, a folder per activity: that train along, or that are scored",
        "DIR",
        group="train and score",
        kind=Path,
    )
    without: str = option(
        "guards that are switched off, of impossible, background, persistent, neighbours, multipath (or all): each"
        " removes points that it takes for something else than the subject",
        "GUARD,...",
        default="",
    )
    pictures: Any = option(
        "a picture of each recording with the points that each guard removed", "DIR", group="score", kind=Path
    )
    points: Any = option(
        "a point cloud, as mmweaver points reads it, or - for standard input", "FILE|-", group="run", kind=Path
    )


def run(asked: Options) -> int:
    """Trains, scores or runs a recogniser.

    Raises:
        InputError: For options of another action, and for files that cannot be used.
    """
    action = asked.action
    needed = {"train": "out", "score": "recordings", "run": "points"}[action]
    if getattr(asked, needed) is None:
        raise InputError(f"recognise {action} needs --{needed}")
    check_mode(asked, action, {"train": "out recordings sequences", "score": "recordings pictures", "run": "points"})
    return {"train": _train, "score": _score, "run": _run}[asked.action](asked)


def _train(asked: Options) -> int:
    from mmweaver.cli.recognise_text import training_lines
    from mmweaver.core.atomic_files import claimed_folder
    from mmweaver.recognition.guards import guard_names
    from mmweaver.recognition.task_file import read_task
    from mmweaver.recognition.train_recogniser import train_recogniser, usual_sequences
    from mmweaver.recognition.training_windows import TrainingOptions

    sequences = usual_sequences(read_task(asked.place)) if asked.sequences is None else asked.sequences
    options = TrainingOptions(
        sequences=sequences, seed=asked.seed, guards_off=tuple(sorted(guard_names(asked.without)))
    )
    with StageBar(0, quiet=asked.quiet) as bar, claimed_folder(asked.out):
        model = train_recogniser(asked.place, asked.out, options, bar.progress, asked.recordings)
    return asked.report({"out": str(asked.out), **model.meta}, *training_lines(model, asked.out))


def _score(asked: Options) -> int:
    from mmweaver.cli.recognise_text import score_lines
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.recognition.guard_report import write_pictures
    from mmweaver.recognition.guards import guard_names
    from mmweaver.recognition.point_recordings import read_task_recordings
    from mmweaver.recognition.recogniser import load_recogniser
    from mmweaver.recognition.scoring import mask_persistent_motion, score_recordings

    if asked.pictures is not None:
        check_output_folder(asked.pictures, overwrite=False)
    model = load_recogniser(asked.place).without(guard_names(asked.without))
    recordings = read_task_recordings(asked.recordings, model.settings)
    scores = score_recordings(model, recordings)
    if asked.pictures is not None:
        asked.pictures.mkdir(parents=True, exist_ok=True)
        points = mask_persistent_motion(model, recordings)[0].points
        scores["pictures"] = [str(file) for file in write_pictures(asked.pictures, points, recordings)]
    return asked.report(scores, *score_lines(scores))


def _run(asked: Options) -> int:
    from mmweaver.cli.recognise_text import contradiction_lines
    from mmweaver.recognition.guard_report import removed_lines, removed_points
    from mmweaver.recognition.guards import guard_names
    from mmweaver.recognition.live_recogniser import recognise_stream
    from mmweaver.recognition.point_recordings import read_task_recording
    from mmweaver.recognition.recogniser import load_recogniser

    model = load_recogniser(asked.place).without(guard_names(asked.without))
    if str(asked.points) == STDIN:
        found = recognise_stream(model, sys.stdin.buffer)
    else:
        recording = read_task_recording(asked.points, model.settings)
        for line in contradiction_lines(model.contradictions([recording])):
            print(line.strip(), file=sys.stderr)
        for line in removed_lines(removed_points(model.points, [recording])):
            print(line, file=sys.stderr)
        found = iter(model.recognise(recording))
    rate_hz = model.settings.frame_rate_hz
    for one in found:
        share = max(one.votes.values())
        outside = "  unlike anything generated" if one.is_outside else ""
        text = f"{one.first_frame / rate_hz:8.1f} s  {one.label}  {share:.2f}{outside}"
        print(one.as_json() if asked.json else text, flush=True)
    return 0
