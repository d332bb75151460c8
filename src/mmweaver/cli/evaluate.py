"""mmweaver evaluate: scores what was trained on generated data alone on recordings of real people."""

import argparse
import json
from pathlib import Path
from typing import Any

from mmweaver.cli.recognise_text import score_lines

SHIPPED_TASK, SHIPPED_MODEL = "examples/tasks/radhar.toml", "recogniser_radhar"

EXAMPLES = """examples:
  mmweaver evaluate zero-shot-activity --recordings RadHAR/Data/Test
  mmweaver evaluate zero-shot-activity --recordings recordings/ --json
  mmweaver evaluate zero-shot-activity --model model/ --recordings recordings/

Without --model the recogniser is that of examples/tasks/radhar.toml. Recordings are of an IWR1443 at 30 frames per
second, as RadHAR publishes them (.txt, one message per point) or as .npz with frame (point) and pts (point, 8). The
activity is the subfolder's name or a word of the file's name: boxing, jack, jump, squats, walk. For other radars and
activities train a model from a task file: docs/recognise.md.
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "evaluate", help="score what was trained on generated data on real recordings", epilog=EXAMPLES,
        description="Trains on generated data alone and scores on recordings of real people.",
    )  # fmt: skip
    parser.add_argument("task", choices=("zero-shot-activity",), help="what is scored")
    parser.add_argument("--recordings", type=Path, required=True, metavar="DIR", help="folder of recordings")
    parser.add_argument("--model", type=Path, metavar="DIR", help="of `mmweaver recognise train`")
    parser.add_argument("--json", action="store_true", help="print the scores for machines")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Prints the scores on stdout. Raises InputError for a folder without readable recordings."""
    scores = _activities(arguments)
    print(json.dumps(scores, indent=2, ensure_ascii=False) if arguments.json else "\n".join(lines(scores)))
    return 0


def _activities(arguments: argparse.Namespace) -> dict[str, Any]:
    """Scores of a recogniser of a task file, by default of the one that comes with the repository."""
    from mmweaver.core.repository_files import repository_file
    from mmweaver.recognition.point_recordings import read_task_recordings
    from mmweaver.recognition.recogniser import META_FILE, load_recogniser
    from mmweaver.recognition.scoring import score_recordings

    folder = arguments.model or repository_file(
        f"{SHIPPED_MODEL}/{META_FILE}", f"the recogniser of {SHIPPED_TASK}",
        "give a model of mmweaver recognise train by --model",
    ).parent  # fmt: skip
    model = load_recogniser(folder)
    made = {name: model.meta.get(name) for name in ("task_file", "generated_windows", "with_disturbed_copies")}
    scores = score_recordings(model, read_task_recordings(arguments.recordings, model.settings))
    return {"task": arguments.task, "model": folder.name, **made, **scores}


def lines(scores: dict[str, Any]) -> list[str]:
    """The scores for people."""
    windows = f"trained on {scores['generated_windows']} generated windows"
    return [f"recogniser {scores['model']} of the task file {scores['task_file']}, {windows}", *score_lines(scores)]
