"""mmweaver motion: a sentence alone, without a photo and without a radar."""

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import number, whole

if TYPE_CHECKING:
    from mmweaver.core.records import PoseSequence

EMPTY_S = 2.0  # of an empty place, whose length nothing decides
EXAMPLES = """examples:
  mmweaver motion "a person walks to the left, then waves"
  mmweaver motion "a person falls, then gets up" --seconds 8 --out fall.npz --picture fall.png
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "motion", help="try a sentence: how it is read, and the moving skeleton on an empty floor", epilog=EXAMPLES,
        description="Reads a sentence and animates it on an empty floor, without a photo and without a radar.",
    )  # fmt: skip
    parser.add_argument("text", metavar="SENTENCE", help="what the person does")
    parser.add_argument("--seconds", type=number, help="how long (default: what the sentence needs)")
    parser.add_argument("--seed", type=whole, default=0, help="the same seed gives the same motion (default 0)")
    parser.add_argument("--height", type=number, metavar="M", help="the person's height (default: by the seed)")
    parser.add_argument("--subject", type=whole, metavar="N", help="the person, 0 to 9999 (default: by the seed)")
    parser.add_argument("--out", type=Path, metavar="NPZ", help="write 22 joints at 120 Hz, as pose.npz holds them")
    parser.add_argument("--picture", type=Path, metavar="PNG", help="draw the body at ten instants")
    parser.add_argument("--json", action="store_true", help="print the reading for machines")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Animates the sentence and writes the requested files. Raises InputError."""
    from mmweaver.motion.empty_floor import act_out
    from mmweaver.motion.empty_scene import says_nobody
    from mmweaver.motion.language.step_names import doing

    _check_files(arguments)
    if says_nobody(arguments.text):
        return _show_nobody(arguments)
    motion = act_out(
        arguments.text, duration_s=arguments.seconds, seed=arguments.seed, height_m=arguments.height,
        subject=arguments.subject,
    )  # fmt: skip
    _write_files(arguments, motion.pose)
    steps = [
        {
            "name": step.name,
            "shown": doing(step),
            "start_s": round(step.start_s, 3),
            "end_s": round(min(step.end_s, motion.plan.duration_s), 3),  # of one that is cut, the time is over before
            "said": step.clause,
        }
        for step in motion.plan.steps
    ]
    if arguments.json:
        files = [str(file) for file in (arguments.out, arguments.picture) if file is not None]
        facts = {
            "text": arguments.text,
            "seconds": motion.plan.duration_s,
            "height_m": round(motion.pose.height_m, 3),
            "subject": motion.pose.subject,
            "steps": steps,
            "clauses": [vars(clause) for clause in motion.clauses],
        }
        print(json.dumps({**facts, "assumptions": motion.assumptions, "files": files}, indent=2))
        return 0
    for step in steps:
        print(f"{step['start_s']:6.2f} to {step['end_s']:5.2f} s   {step['shown']}")
    for sentence in motion.assumptions:
        print(f"  assumed: {sentence}")
    return 0


def _show_nobody(arguments: argparse.Namespace) -> int:
    """An empty place has no steps, and joints of nobody at the times of a motion. Raises InputError for a body."""
    from mmweaver.core.atomic_files import atomic_file
    from mmweaver.core.errors import InputError
    from mmweaver.formats.npz_files import write_pose_npz
    from mmweaver.motion.animation.assemble import dense_times
    from mmweaver.motion.language.timing import LONGEST_S

    if any(one is not None for one in (arguments.height, arguments.subject, arguments.picture)):
        raise InputError("nobody is there: leave out --height, --subject and --picture, or say what a person does")
    seconds = EMPTY_S if arguments.seconds is None else arguments.seconds
    if not 0 < seconds <= LONGEST_S:
        raise InputError(f"a duration of {seconds:g} s is not possible; choose above 0 and up to {LONGEST_S:g} s")
    files = [] if arguments.out is None else [arguments.out]
    for file in files:
        with atomic_file(file) as temporary:
            write_pose_npz(temporary, time_s=dense_times(seconds))
    if arguments.json:
        facts = {"text": arguments.text, "seconds": seconds, "people": [], "steps": [], "clauses": []}
        print(json.dumps({**facts, "assumptions": [], "files": list(map(str, files))}, indent=2))
    else:
        print(f"{0:6.2f} to {seconds:5.2f} s   nobody: an empty place")
    return 0


def _write_files(arguments: argparse.Namespace, pose: "PoseSequence") -> None:
    """Writes joints and picture, both or none."""
    from mmweaver.core.atomic_files import atomic_files
    from mmweaver.figures.motion_strip import draw_strip
    from mmweaver.formats.npz_files import write_pose_npz

    files = [file for file in (arguments.out, arguments.picture) if file is not None]
    if not files:
        return
    with atomic_files(*files) as temporaries:
        for file, temporary in zip(files, temporaries, strict=True):
            if file is arguments.out:
                write_pose_npz(temporary, pose)
            else:
                draw_strip(pose, temporary, title=arguments.text)


def _check_files(arguments: argparse.Namespace) -> None:
    """What is cheap to refuse is refused before anything is made."""
    from mmweaver.core.errors import InputError
    from mmweaver.core.output_checks import check_output_file

    if arguments.out is not None and arguments.out.suffix != ".npz":
        raise InputError(f"{arguments.out} does not end in .npz; joints are written as .npz")
    if arguments.picture is not None and arguments.picture.suffix not in (".png", ".pdf", ".svg"):
        raise InputError(f"{arguments.picture} does not end in .png, .pdf or .svg; choose one of these")
    for file in (arguments.out, arguments.picture):
        if file is not None:
            check_output_file(file, overwrite=True)
