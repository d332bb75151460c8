"""mmweaver recognise: a recogniser of activities, trained on generated data alone, scored and used."""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from mmweaver.cli.arguments import whole
from mmweaver.core.errors import InputError

EXAMPLES = """examples:
  mmweaver recognise train examples/tasks/radhar.toml --out model/
  mmweaver recognise train TASK.toml --labelled few_recordings/ --out model/
  mmweaver recognise score model/ --recordings recordings/ --json
  mmweaver recognise run model/ --points log.dat
  cat /dev/ttyUSB1 | mmweaver recognise run model/ --points - --json

TASK.toml names the radar, the activities in sentences, and how recordings are stored: docs/recognise.md. Recordings
lie in folders named by activity: .npz with frame and pts, TI .dat, or whatever mmweaver points reads. A pipe brings
the bytes of a TI demo's data port, or CSV lines: Frame,X,Y,Z,Doppler.
"""
STDIN = "-"


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "recognise", help="train a recogniser of activities on generated data, score it, run it", epilog=EXAMPLES,
        description="Trains a recogniser of activities from a page of text, without any recording; scores it on"
        " labelled recordings; labels point clouds from a file or a pipe.",
    )  # fmt: skip
    parser.add_argument("action", choices=("train", "score", "run"), help="what is done")
    parser.add_argument("place", type=Path, metavar="TASK.toml|MODEL", help="train: the task; else the trained folder")
    train = parser.add_argument_group("train")
    train.add_argument("--out", type=Path, metavar="DIR", help="folder of the recogniser; the same command resumes it")
    train.add_argument(
        "--sequences", type=whole, metavar="N",
        help="people that perform each activity (default 40, of gestures that are done once 100)",
    )  # fmt: skip
    train.add_argument("--quick", action="store_true", help="8 people: a first look, less accurate")
    train.add_argument(
        "--labelled", type=Path, metavar="DIR", help="labelled recordings that train along, a folder an activity"
    )
    train.add_argument("--seed", type=whole, default=0, help="of people, rooms and trees (default 0)")
    score = parser.add_argument_group("score")
    score.add_argument("--recordings", type=Path, metavar="DIR", help="labelled recordings, a folder an activity")
    run = parser.add_argument_group("run")
    run.add_argument("--points", type=Path, metavar="FILE|-", help="a recording, or - for a pipe")
    parser.add_argument("--json", action="store_true", help="print for machines; run: one object a window")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors and what was asked for")
    parser.set_defaults(run=run_command)
    return parser


def run_command(arguments: argparse.Namespace) -> int:
    """Does the action. Raises InputError for options that another action has, and for bad files."""
    needed = {"train": "out", "score": "recordings", "run": "points"}[arguments.action]
    if getattr(arguments, needed) is None:
        raise InputError(f"recognise {arguments.action} needs --{needed}")
    for name in {"out", "recordings", "points"} - {needed}:
        if getattr(arguments, name) is not None:
            raise InputError(f"--{name} is no option of recognise {arguments.action}")
    if arguments.labelled is not None and arguments.action != "train":
        raise InputError(f"--labelled is no option of recognise {arguments.action}")
    return {"train": _train, "score": _score, "run": _run}[arguments.action](arguments)


def _train(arguments: argparse.Namespace) -> int:
    from mmweaver.cli.recognise_text import training_lines
    from mmweaver.recognition.task_file import read_task
    from mmweaver.recognition.train_recogniser import QUICK_SEQUENCES, train_recogniser, usual_sequences
    from mmweaver.recognition.training_windows import TrainingOptions

    usual = QUICK_SEQUENCES if arguments.quick else usual_sequences(read_task(arguments.place))
    sequences = usual if arguments.sequences is None else arguments.sequences
    options = TrainingOptions(sequences=sequences, seed=arguments.seed)
    with _Progress(quiet=arguments.quiet) as progress:
        model = train_recogniser(arguments.place, arguments.out, options, progress, arguments.labelled)
    if arguments.json:
        print(json.dumps({"out": str(arguments.out), **model.meta}, indent=2, ensure_ascii=False))
    elif not arguments.quiet:
        print("\n".join(training_lines(model, arguments.out)))
    return 0


def _score(arguments: argparse.Namespace) -> int:
    from mmweaver.cli.recognise_text import score_lines
    from mmweaver.recognition.point_recordings import read_task_recordings
    from mmweaver.recognition.recogniser import load_recogniser
    from mmweaver.recognition.scoring import score_recordings

    model = load_recogniser(arguments.place)
    recordings = read_task_recordings(arguments.recordings, model.settings)
    scores = score_recordings(model, recordings)
    print(json.dumps(scores, indent=2, ensure_ascii=False) if arguments.json else "\n".join(score_lines(scores)))
    return 0


def _run(arguments: argparse.Namespace) -> int:
    from mmweaver.cli.recognise_text import contradiction_lines
    from mmweaver.recognition.live_recogniser import recognise_stream
    from mmweaver.recognition.point_recordings import read_task_recording
    from mmweaver.recognition.recogniser import load_recogniser

    model = load_recogniser(arguments.place)
    if str(arguments.points) == STDIN:
        found = recognise_stream(model, sys.stdin.buffer)
    else:
        recording = read_task_recording(arguments.points, model.settings)
        for line in contradiction_lines(model.contradictions([recording])):
            print(line.strip(), file=sys.stderr)
        found = iter(model.recognise(recording))
    rate_hz = model.settings.frame_rate_hz
    for one in found:
        share = max(one.votes.values())
        outside = "  unlike anything generated" if one.is_outside else ""
        text = f"{one.first_frame / rate_hz:8.1f} s  {one.label}  {share:.2f}{outside}"
        print(one.as_json() if arguments.json else text, flush=True)
    return 0


class _Progress:
    """A bar on a terminal, lines now and then elsewhere."""

    def __init__(self, *, quiet: bool):
        self._quiet, self._bar = quiet, None

    def __enter__(self) -> "_Progress":
        return self

    def __call__(self, stage: str, done: int, of: int) -> None:
        if self._quiet or not sys.stderr.isatty():
            return
        from tqdm import tqdm

        if self._bar is None or self._bar.desc != stage:
            self._close()
            self._bar = tqdm(desc=stage, total=of, file=sys.stderr, leave=False)
        self._bar.n = done
        self._bar.refresh()

    def __exit__(self, *_: object) -> None:
        self._close()

    def _close(self) -> None:
        if self._bar is not None:
            self._bar.close()
