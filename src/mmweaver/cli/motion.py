"""mmweaver motion: a sentence alone, without a photo and without a radar."""

from pathlib import Path
from typing import TYPE_CHECKING

from mmweaver.cli.option_groups import Printed
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options

if TYPE_CHECKING:
    from mmweaver.core.records import PoseSequence

AMASS = ".amass.npz"
SUFFIXES = (".npz", ".bvh", ".npy", ".png", ".pdf", ".svg")
EXAMPLES = """examples:
  mmweaver motion "a person walks to the left, then waves"
  mmweaver motion "a person falls, then gets up" --seconds 8 --out fall.npz --out fall.png
  mmweaver motion "a person waves" --out wave.bvh --out wave.amass.npz
"""


@options
class Options(Printed):
    """Reads a sentence and animates it on an empty floor, without a photo and without a radar."""

    text: str = option("what the person does", "SENTENCE", default=MISSING, positional=True)
    seconds: float | None = option("duration in seconds (default: what the sentence needs)", "S")
    seed: int = option("the same seed gives the same motion", "N", default=0)
    height: float | None = option("the person's height in metres (default: by the seed)", "M")
    subject: int | None = option("the person, 0 to 9999 (default: by the seed)", "N")
    out: list[Path] | None = option(
        "write 22 joints at 120 Hz, as pose.npz holds them, as BVH (.bvh), as SMPL poses of AMASS (.amass.npz) or as"
        " HumanML3D's features at 20 Hz (.npy); or draw the body at ten instants (.png, .pdf, .svg); once more for"
        " several",
        "NPZ|BVH|NPY|PNG",
    )


def run(asked: Options) -> int:
    """Animates the sentence and writes the requested files. Raises InputError."""
    from mmweaver.motion.empty_floor import act_out, says_nobody
    from mmweaver.motion.language.postures import doing

    _check_files(asked)
    if says_nobody(asked.text):
        raise InputError(f"{asked.text[:60]!r} is an empty place, which has no motion; say what a person does")
    motion = act_out(
        asked.text,
        duration_s=asked.seconds,
        seed=asked.seed,
        height_m=asked.height,
        subject=asked.subject,
    )
    _write_files(asked, motion.pose)
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
    facts = {
        "text": asked.text,
        "seconds": motion.plan.duration_s,
        "height_m": round(motion.pose.height_m, 3),
        "subject": motion.pose.subject,
        "steps": steps,
        "clauses": [vars(clause) for clause in motion.clauses],
        "assumptions": motion.assumptions,
        "files": [str(file) for file in asked.out or ()],
    }
    lines = [f"{step['start_s']:6.2f} to {step['end_s']:5.2f} s   {step['shown']}" for step in steps]
    return asked.report(facts, *lines, *(f"  assumed: {sentence}" for sentence in motion.assumptions))


def _write_files(asked: Options, pose: "PoseSequence") -> None:
    """Writes joints and picture, both or neither."""
    from mmweaver.core.atomic_files import atomic_files
    from mmweaver.io.npz_files import write_pose_npz
    from mmweaver.motion.mocap.write_motion import write_amass, write_bvh, write_humanml3d
    from mmweaver.viz.motion_strip import draw_strip

    files = asked.out or []
    with atomic_files(*files) as temporaries:
        for file, temporary in zip(files, temporaries, strict=True):
            if file.name.endswith(AMASS):
                write_amass(temporary, pose)
            elif file.suffix == ".npz":
                write_pose_npz(temporary, pose)
            elif file.suffix == ".bvh":
                write_bvh(temporary, pose)
            elif file.suffix == ".npy":
                write_humanml3d(temporary, pose)
            else:
                draw_strip(pose, temporary, title=asked.text)


def _check_files(asked: Options) -> None:
    """Rejects impossible outputs before anything is computed."""
    from mmweaver.core.output_checks import check_output_file

    for file in asked.out or ():
        if file.suffix not in SUFFIXES:
            raise InputError(
                f"{file} does not end in {', '.join(SUFFIXES)}; joints are .npz, .bvh or .npy, pictures the others"
            )
        check_output_file(file, overwrite=True)
