"""mmweaver evaluate: scores what was trained on generated data alone on recordings of real people."""

from pathlib import Path
from typing import Any, Literal

from mmweaver.cli.option_groups import Printed
from mmweaver.cli.recognise_text import score_lines
from mmweaver.core.options import MISSING, option, options

SHIPPED_TASK, SHIPPED_MODEL = "examples/tasks/radhar.toml", "recogniser_radhar"

EXAMPLES = """examples:
  mmweaver evaluate zero-shot-activity --recordings RadHAR/Data/Test
  mmweaver evaluate zero-shot-activity --recordings recordings/ --json
  mmweaver evaluate zero-shot-activity --weights model/ --recordings recordings/

Without --weights the recogniser is that of examples/tasks/radhar.toml. Recordings are of an IWR1443 at 30 frames per
second, as RadHAR publishes them (.txt, one message per point) or as .npz with frame (point) and pts (point, 8). The
activity is the subfolder's name or a word of the file's name: boxing, jack, jump, squats, walk. For other radars and
activities train a model from a task file: docs/recognise.md.
"""


@options
class Options(Printed):
    """Trains on generated data alone and scores on recordings of real people."""

    task: Literal["zero-shot-activity"] = option("what is scored", default=MISSING, positional=True)
    recordings: Path = option("folder of recordings", "DIR", default=MISSING)
    weights: Path | None = option("a folder of mmweaver recognise train", "DIR")


def run(asked: Options) -> int:
    """Prints the scores on stdout. Raises InputError for a folder without readable recordings."""
    scores = _activities(asked)
    return asked.report(scores, *lines(scores))


def _activities(asked: Options) -> dict[str, Any]:
    """Scores of a recogniser of a task file, by default of the one that comes with the repository."""
    from mmweaver.core.repository_files import repository_file
    from mmweaver.recognition.point_recordings import read_task_recordings
    from mmweaver.recognition.recogniser import META_FILE, load_recogniser
    from mmweaver.recognition.scoring import score_recordings

    folder = (
        asked.weights
        or repository_file(
            f"{SHIPPED_MODEL}/{META_FILE}",
            f"the recogniser of {SHIPPED_TASK}",
            "give a model of mmweaver recognise train by --weights",
        ).parent
    )
    model = load_recogniser(folder)
    made = {name: model.meta.get(name) for name in ("task_file", "generated_windows", "with_disturbed_copies")}
    scores = score_recordings(model, read_task_recordings(asked.recordings, model.settings))
    return {"task": asked.task, "model": folder.name, **made, **scores}


def lines(scores: dict[str, Any]) -> list[str]:
    """The scores for people."""
    windows = f"trained on {scores['generated_windows']} generated windows"
    return [f"recogniser {scores['model']} of the task file {scores['task_file']}, {windows}", *score_lines(scores)]
