"""The pictures of docs/motion.md: every activity of the library as a strip of bodies.

python -m studies run motion_sheet --out docs/images
"""

import argparse
from pathlib import Path

from mmweaver.core.records import PoseSequence
from mmweaver.motion.empty_floor import act_out
from mmweaver.motion.language.activities import BODY, HANDS, Activity
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.timing import natural_s
from mmweaver.viz.motion_strip import draw_sheet
from studies.manifest import StudyRun

SEED = 1
COLOURS = 64


def strip_of(activity: Activity) -> tuple[str, PoseSequence]:
    """An activity's name and its example acted out in its natural time."""
    seconds = max(1.3 * activity.natural_s, 1.1 * natural_s(parse(activity.example)), 1.6)
    return activity.name, act_out(activity.example, duration_s=seconds, seed=SEED, height_m=1.75).pose


def in_few_colours(path: Path) -> None:
    """Writes a picture again with a palette, a third of its size."""
    from PIL import Image

    with Image.open(path) as picture:
        small = picture.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
    small.save(path, optimize=True)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", type=Path, default=Path("docs/images"))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    for activities, name in ((BODY, "motions_body.png"), (HANDS, "motions_hands.png")):
        draw_sheet([strip_of(activity) for activity in activities], options.out / name)
        in_few_colours(options.out / name)
