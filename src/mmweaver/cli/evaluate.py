"""mmweaver evaluate: scores a recogniser, trained on generated data alone, on recordings of real people."""

import argparse
import json
from pathlib import Path
from typing import Any

from mmweaver.cli.recognise_text import accuracy_lines, confusion_lines

EXAMPLES = """examples:
  mmweaver evaluate zero-shot-activity --recordings RadHAR/Data/Test
  mmweaver evaluate zero-shot-activity --recordings recordings/ --json

The recordings are of an IWR1443 at 30 frames a second, as RadHAR publishes them (.txt, one message a point) or as
.npz with frame (point) and pts (point, 8). The activity is the subfolder's name or a word of the file's name: boxing,
jack, jump, squats, walk. For other radars and activities: docs/zero_shot.md.
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "evaluate", help="score what was trained on generated data on real recordings", epilog=EXAMPLES,
        description="Trains on generated data alone and scores on recordings of real people.",
    )  # fmt: skip
    parser.add_argument("task", choices=("zero-shot-activity",), help="what is recognised")
    parser.add_argument("--recordings", type=Path, required=True, metavar="DIR", help="folder of recordings")
    parser.add_argument(
        "--frozen", choices=("development", "blind"), default="development",
        help="which frozen recogniser: the one after development (default) or the blind one before it",
    )  # fmt: skip
    parser.add_argument("--json", action="store_true", help="print the scores for machines")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Prints the scores on stdout. Raises InputError for a folder without readable recordings."""
    from mmweaver.recognition.frozen_activity import load_frozen
    from mmweaver.recognition.point_recording_files import read_point_recordings
    from mmweaver.recognition.scoring import evaluate_recogniser, report

    frozen = load_frozen(arguments.frozen)
    recordings = read_point_recordings(arguments.recordings, frozen.labels)
    scores = report(evaluate_recogniser(frozen.train(), recordings, frozen.window_s))
    scores = {"task": arguments.task, "frozen": arguments.frozen, **frozen.provenance, **scores}
    print(json.dumps(scores, indent=2) if arguments.json else "\n".join(lines(scores)))
    return 0


def lines(scores: dict[str, Any]) -> list[str]:
    """The scores for people."""
    head = f"{scores['recordings']} recordings; trained on {scores['generated_windows']} generated windows alone"
    return [head, *accuracy_lines(scores, "windows of 2 s"), *confusion_lines(scores)]
