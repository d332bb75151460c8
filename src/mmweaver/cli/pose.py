"""mmweaver pose: joints of a person from a radar's points, by a network trained on generated people."""

import argparse
import json
from pathlib import Path
from typing import Any

EXAMPLES = """examples:
  mmweaver train pose examples/tasks/mars_poses.toml --out model/
  mmweaver pose model/ --points log.dat --out poses/
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "pose", help="estimate the poses of a person from a radar's points", epilog=EXAMPLES,
        description="Estimates 22 joints for every frame of a point cloud, in the radar's level axes, and writes"
        " pose.npz with a picture. The network is one of mmweaver train pose.",
    )  # fmt: skip
    parser.add_argument("model", type=Path, metavar="MODEL", help="folder of mmweaver train pose, or its weights")
    parser.add_argument("--points", type=Path, required=True, metavar="FILE", help="a recording of one person")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for pose.npz and pose.png")
    parser.add_argument("--overwrite", action="store_true", help="replace files of an earlier run")
    parser.add_argument("--json", action="store_true", help="print a summary for machines")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Writes the poses. Raises InputError."""
    from mmweaver.core.atomic_files import atomic_file
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.figures.motion_strip import draw_pose_strips
    from mmweaver.formats.npz_files import write_pose_npz
    from mmweaver.recognition.point_recordings import read_task_recording
    from mmweaver.recognition.pose_estimator import load_estimator

    files = ("pose.npz", "pose.png")
    check_output_folder(arguments.out, overwrite=arguments.overwrite, files=files, inputs=[arguments.points])
    estimator = load_estimator(arguments.model)
    recording = read_task_recording(arguments.points, estimator.settings)
    pose = estimator.estimate(recording.cloud, recording.num_frames)
    with atomic_file(arguments.out / files[0]) as temporary:
        write_pose_npz(temporary, pose)
    rate_hz = estimator.settings.frame_rate_hz
    title = f"{recording.name}: as the radar sees the person; left limbs blue, right limbs red"
    draw_pose_strips([(title, pose.joints_m, None)], arguments.out / files[1], frame_rate_hz=rate_hz)
    seen = len(set(recording.cloud.frame.tolist()))
    summary = {
        "out": str(arguments.out), "frames": recording.num_frames, "frames_with_points": seen,
        "seconds": recording.num_frames / rate_hz,
    }  # fmt: skip
    if arguments.json:
        print(json.dumps(summary))
    elif not arguments.quiet:
        text = f"wrote {arguments.out}: {recording.num_frames} poses, {summary['seconds']:.1f} s"
        guessed = recording.num_frames - seen
        print(text + (f"; {guessed} frames have no points, their poses are guessed" if guessed else ""))
    return 0
