"""mmweaver pose: joints of a person from a radar's points, by a network trained on generated people."""

from pathlib import Path

from mmweaver.cli.option_groups import Written
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver train pose examples/tasks/mars_poses.toml --out model/
  mmweaver pose model/ --points log.dat --out poses/
"""


@options
class Options(Written):
    """Estimates 22 joints for every frame of a point cloud, in the radar's level axes, and writes pose.npz with a
    picture. The network is one of mmweaver train pose.
    """

    model: Path = option("folder of mmweaver train pose, or its weights", "MODEL", default=MISSING, positional=True)
    points: Path = option("point cloud of one person, as mmweaver points reads it", "FILE", default=MISSING)
    out: Path = option("folder for pose.npz and pose.png", "DIR", default=MISSING)


def run(asked: Options) -> int:
    """Writes the poses. Raises InputError."""
    from mmweaver.core.atomic_files import atomic_file
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.io.npz_files import write_pose_npz
    from mmweaver.recognition.point_recordings import read_task_recording
    from mmweaver.recognition.train_pose import load_estimator
    from mmweaver.viz.motion_strip import draw_pose_strips

    files = ("pose.npz", "pose.png")
    check_output_folder(asked.out, overwrite=asked.overwrite, files=files, inputs=[asked.points])
    estimator = load_estimator(asked.model)
    recording = read_task_recording(asked.points, estimator.settings)
    pose = estimator.estimate(recording.cloud, recording.num_frames)
    with atomic_file(asked.out / files[0]) as temporary:
        write_pose_npz(temporary, pose)
    rate_hz = estimator.settings.frame_rate_hz
    title = f"{recording.name}: as the radar sees the person; left limbs blue, right limbs red"
    draw_pose_strips([(title, pose.joints_m, None)], asked.out / files[1], frame_rate_hz=rate_hz)
    seen = len(set(recording.cloud.frame.tolist()))
    summary = {
        "out": str(asked.out),
        "frames": recording.num_frames,
        "frames_with_points": seen,
        "seconds": recording.num_frames / rate_hz,
    }
    guessed = recording.num_frames - seen
    note = f"; {guessed} frames have no points, their poses are guessed" if guessed else ""
    text = f"wrote {asked.out}: {recording.num_frames} poses, {summary['seconds']:.1f} s{note}"
    return asked.report(summary, text)
