"""mmweaver evaluate: scores a recogniser, trained on generated data alone, on recordings of real people."""

import argparse
import json
from pathlib import Path
from typing import Any

from mmweaver.cli.recognise_text import accuracy_lines, confusion_lines, score_lines

EXAMPLES = """examples:
  mmweaver evaluate zero-shot-activity --recordings RadHAR/Data/Test
  mmweaver evaluate zero-shot-activity --recordings recordings/ --json
  mmweaver evaluate zero-shot-activity --model model/ --recordings recordings/

Without --model the recordings are of an IWR1443 at 30 frames a second, as RadHAR publishes them (.txt, one message a
point) or as .npz with frame (point) and pts (point, 8). The activity is the subfolder's name or a word of the file's
name: boxing, jack, jump, squats, walk. For other radars and activities train a model from a task file:
docs/recognise.md.
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "evaluate", help="score what was trained on generated data on real recordings", epilog=EXAMPLES,
        description="Trains on generated data alone and scores on recordings of real people.",
    )  # fmt: skip
    parser.add_argument("task", choices=("zero-shot-activity",), help="what is recognised")
    parser.add_argument("--recordings", type=Path, required=True, metavar="DIR", help="folder of recordings")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--model", type=Path, metavar="DIR", help="a recogniser of `mmweaver recognise train`")
    which.add_argument(
        "--frozen", choices=("development", "blind"), default="development",
        help="which frozen recogniser: the one after development (default) or the blind one before it",
    )  # fmt: skip
    parser.add_argument("--json", action="store_true", help="print the scores for machines")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Prints the scores on stdout. Raises InputError for a folder without readable recordings."""
    scores = _of_frozen(arguments) if arguments.model is None else _of_model(arguments)
    print(json.dumps(scores, indent=2, ensure_ascii=False) if arguments.json else "\n".join(lines(scores)))
    return 0


def _of_model(arguments: argparse.Namespace) -> dict[str, Any]:
    """Scores of a recogniser of a task file."""
    from mmweaver.recognition.recogniser import load_recogniser
    from mmweaver.recognition.score_recogniser import score_recogniser

    model = load_recogniser(arguments.model)
    made = {name: model.meta.get(name) for name in ("generated_windows", "with_disturbed_copies")}
    scores = score_recogniser(model, arguments.recordings)
    return {"task": arguments.task, "model": arguments.model.name, **made, **scores}


def _of_frozen(arguments: argparse.Namespace) -> dict[str, Any]:
    """Scores of the recogniser of RadHAR's activities that comes with the package."""
    from mmweaver.recognition.frozen_activity import load_frozen
    from mmweaver.recognition.point_recording_files import read_point_recordings
    from mmweaver.recognition.scoring import evaluate_recogniser, report

    frozen = load_frozen(arguments.frozen)
    recordings = read_point_recordings(arguments.recordings, frozen.labels)
    scores = report(evaluate_recogniser(frozen.train(), recordings, frozen.window_s))
    return {"task": arguments.task, "frozen": arguments.frozen, **frozen.provenance, **scores}


def lines(scores: dict[str, Any]) -> list[str]:
    """The scores for people."""
    if "distance" in scores:
        return score_lines(scores)
    head = f"{scores['recordings']} recordings; trained on {scores['generated_windows']} generated windows alone"
    return [head, *accuracy_lines(scores, "windows of 2 s"), *confusion_lines(scores)]
