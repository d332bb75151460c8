"""The options of `mmweaver generate` for a motion of one's own instead of a sentence."""

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import Options, Rare, number, points, source, whole
from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.motion.mocap.clip import MotionClip

# options that need --motion
OF_MOTION = ("motion_fps", "motion_unit", "motion_up", "motion_start", "clip", "body_model")


def add_motion_options(parser: Options) -> None:
    """Declares --motion and what goes with it."""
    parser.add_argument(
        "--height", type=number, action="append", metavar="M",
        help="the person's height (default: as the text says, else by seed, or recorded); of several people once for"
        " each",
    )  # fmt: skip
    parser.add_argument(
        "--subject", type=whole, action="append", metavar="N",
        help="the person, 0 to 9999: skin, build, habits and usual height (default: by seed); of several people once"
        " for each",
    )  # fmt: skip
    parser.add_argument(
        "--motion", type=Path, metavar="FILE",
        help="a recorded motion instead of the first --text, which then only names it: .bvh, .npz (AMASS, SMPL, CMU,"
        " joints), .npy (22 joints, HumanML3D)",
    )  # fmt: skip
    parser.add_argument(
        "--motion-model", type=source, metavar="PATH|NAME",
        help=Rare("a motion model for a --text that the built-in library does not know: MotionGPT (a checkpoint's file,"
        " folder or name on the Hub, or 'small'; needs the extra 'pretrained'), a plug-in's name, or module:attribute"),
    )  # fmt: skip
    parser.add_argument(
        "--motion-model-for", choices=("unknown", "all"), default="unknown",
        help=Rare("which sentences the motion model acts out: unknown ones (default) or all"),
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
        help=Rare("the direction that the person faces first: 0 towards the radar, 90 to the picture's right, 180 away"
        " (default: as the text says, else by seed)"),
    )  # fmt: skip
    parser.add_argument(
        "--path", type=points, metavar="'X,Y X,Y ...'",
        help=Rare("where the person walks: corners in metres right of and ahead of the radar"),
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
        if arguments.path is not None:
            raise InputError("--path is for a sentence; a recorded --motion has its own path, leave one of them out")
        if arguments.as_recorded and not (arguments.at is None and arguments.heading is None):
            raise InputError("--as-recorded moves nothing; leave out --at and --heading, or leave out --as-recorded")
        return
    given = [name for name in OF_MOTION if getattr(arguments, name) is not None]
    given += ["as_recorded"] if arguments.as_recorded else []
    if given:
        raise InputError(f"--{given[0].replace('_', '-')} is about a recorded motion; give --motion too")


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


def motion_of_model(arguments: argparse.Namespace, text: str | None, seconds: float | None) -> "MotionClip | None":
    """The motion that --motion-model makes of the text; None of a text that the library knows."""
    from mmweaver.motion.motion_models import MotionTask, clip_of, load_motion_model

    if arguments.motion_model_for == "unknown" and _is_known(text or ""):
        return None
    path_m, at = arguments.path or (), arguments.at
    start_m = path_m[0] if path_m else at[0] if at else None
    task = MotionTask(sentence=text or "", start_m=start_m, path_m=path_m, seconds=seconds, seed=arguments.seed)
    return clip_of(load_motion_model(arguments.motion_model), task)


def _is_known(text: str) -> bool:
    from mmweaver.motion.language.sentence_parser import parse_sentence

    try:
        parse_sentence(text)
    except InputError:
        return False
    return True


def placing_options(arguments: argparse.Namespace, *, of_model: "MotionClip | None" = None) -> dict[str, Any]:
    """The arguments of `Weaver.request` about body and place; `of_model`: the motion, if a model made it."""
    if of_model is not None and arguments.path:
        from mmweaver.motion.motion_models import heading_of

        return {
            "at": arguments.path[0], "heading_rad": heading_of(arguments.path, of_model),
            "height_m": _one_or_all(arguments.height, 1), "subject": _one_or_all(arguments.subject, 1),
        }  # fmt: skip
    people = len(arguments.text or [""])
    heading = None if arguments.heading is None else math.radians(arguments.heading) - math.pi / 2
    return {
        "at": _one_or_all(arguments.at, people), "heading_rad": heading, "path_m": arguments.path,
        "height_m": _one_or_all(arguments.height, people), "subject": _one_or_all(arguments.subject, people),
        "as_recorded": arguments.as_recorded,
    }  # fmt: skip


def _one_or_all(given: list[Any] | None, people: int) -> Any:
    """The single value of a single person, or the list of several people's."""
    return given[0] if given is not None and len(given) == 1 and people == 1 else given
