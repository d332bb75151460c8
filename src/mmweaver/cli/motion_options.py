"""The options of `mmweaver generate` for a motion of one's own instead of a sentence."""

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import Options, Rare, number, source
from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.motion.mocap.clip import MotionClip

# options that need --motion
OF_MOTION = ("motion_fps", "motion_unit", "motion_up", "motion_start", "clip", "body_model")


def add_motion_options(parser: Options) -> None:
    """Declares --motion and what goes with it."""
    parser.add_argument(
        "--height", type=number, action="append", metavar="M",
        help="the person's height (default: by seed, or recorded); of several people once for each",
    )  # fmt: skip
    parser.add_argument(
        "--motion", type=Path, metavar="FILE",
        help="a recorded motion instead of the first --text, which then only names it: .bvh, .npz (AMASS, SMPL, CMU,"
        " joints), .npy (22 joints, HumanML3D)",
    )  # fmt: skip
    parser.add_argument(
        "--motion-model", type=source, metavar="PATH|NAME",
        help=Rare("a MotionGPT that acts out --text instead of the built-in library: a checkpoint's file, folder or"
        " name on the Hub, or 'small'; needs the extra 'motiongpt'"),
    )  # fmt: skip
    parser.add_argument(
        "--motion-fps", type=number, metavar="N", help=Rare("its frames per second, where the file does not say")
    )
    parser.add_argument(
        "--motion-unit", metavar="UNIT",
        help=Rare("its unit: m, cm, mm, inch or metres in one unit (default: by body size)"),
    )  # fmt: skip
    parser.add_argument(
        "--motion-up", metavar="AXIS", help=Rare("its upward axis: y, z, ... (default: where the head is)")
    )
    parser.add_argument(
        "--motion-start", type=number, metavar="S", help=Rare("the second at which it begins (default 0)")
    )
    parser.add_argument("--clip", metavar="NAME", help=Rare("which motion, where a file holds several"))
    parser.add_argument(
        "--body-model", type=Path, metavar="NPZ", help=Rare("your own SMPL model, for bones in the recorded shape")
    )
    parser.add_argument(
        "--heading", type=number, metavar="DEG",
        help=Rare("the direction that the motion faces first: 0 towards the radar, 90 to the picture's right, 180 away"
        " (default: chosen)"),
    )  # fmt: skip
    parser.add_argument(
        "--as-recorded", action="store_true",
        help=Rare("the motion's positions are the radar's own (x right, y away, z up); nothing is moved or checked"),
    )  # fmt: skip


def check_motion_options(arguments: argparse.Namespace) -> None:
    """Raises InputError for options that contradict each other."""
    if arguments.motion is not None and arguments.motion_model is not None:
        raise InputError("--motion is a recorded motion, --motion-model makes one of --text; give one of them")
    if arguments.motion_model is not None and arguments.text is None and not arguments.demo:
        raise InputError("--motion-model acts out a text; give --text")
    if arguments.motion is not None:
        if arguments.as_recorded and not (arguments.at is None and arguments.heading is None):
            raise InputError("--as-recorded moves nothing; leave out --at and --heading, or leave out --as-recorded")
        return
    given = [name for name in OF_MOTION if getattr(arguments, name) is not None]
    given += ["as_recorded"] if arguments.as_recorded else []
    if given:
        raise InputError(f"--{given[0].replace('_', '-')} is about a recorded motion; give --motion too")
    if arguments.heading is not None and arguments.motion_model is None:
        raise InputError("--heading is for a recorded --motion; with --text say it in the sentence ('facing left')")


def read_own_motion(arguments: argparse.Namespace) -> "MotionClip | None":
    """The motion that --motion names, from its --motion-start on."""
    if arguments.motion is None:
        return None
    from mmweaver.motion.mocap.read_motion import read_motion

    clip = read_motion(
        arguments.motion, fps=arguments.motion_fps, unit=arguments.motion_unit, up=arguments.motion_up,
        clip=arguments.clip, body_model=arguments.body_model,
    )  # fmt: skip
    return clip.after(arguments.motion_start) if arguments.motion_start is not None else clip


def motion_of_model(model: str, text: str | None, duration_s: float, seed: int) -> "MotionClip":
    """The motion that a --motion-model generates from the text."""
    from mmweaver.motion.motiongpt.motiongpt import MotionGPT

    return MotionGPT.load(model).generate(text or "", seconds=duration_s, seed=seed)


def placing_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The arguments of `Weaver.request` about body and place."""
    people = len(arguments.text or [""])
    heading = None if arguments.heading is None else math.radians(arguments.heading) - math.pi / 2
    return {
        "at": _one_or_all(arguments.at, people), "heading_rad": heading,
        "height_m": _one_or_all(arguments.height, people), "as_recorded": arguments.as_recorded,
    }  # fmt: skip


def _one_or_all(given: list[Any] | None, people: int) -> Any:
    """The single value of a single person, or the list of several people's."""
    return given[0] if given is not None and len(given) == 1 and people == 1 else given
