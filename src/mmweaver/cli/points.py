"""mmweaver points: point clouds of boards and data sets become points.npz."""

from pathlib import Path
from typing import Any

from mmweaver.cli.option_groups import Written
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver points xwr68xx_log.dat -o points.npz          # the data port of a TI demo, people tracking too
  mmweaver points radar_data.csv -o points.npz           # Frame #,# Obj,X,Y,Z,Doppler,Intensity
  mmweaver points E01/S01/A01/mmwave/ -o points.npz      # frames of MM-Fi
"""


@options
class Options(Written):
    """Reads a logged point cloud and writes it as points.npz: frame, x right, y away, z up in metres, radial velocity
    in m/s (away +), SNR in dB and intensity where it has them.
    """

    file: Path = option("the log, or a folder of frames", "FILE|DIR", default=MISSING, positional=True)
    out: Path = option("the points.npz to write", "FILE", default=MISSING, short="-o")
    layout: str | None = option(
        "ti_uart, ti_replay, csv, mmfi, radhar, npz, arrays, ros or points (default: by the file itself)", "NAME"
    )


def run(asked: Options) -> int:
    """Reads the points and writes them.

    Raises:
        InputError: If they cannot be read or written.
    """
    import numpy as np

    from mmweaver.core.atomic_files import atomic_file
    from mmweaver.core.output_checks import check_output_file
    from mmweaver.io.npz_files import write_points_npz
    from mmweaver.io.point_clouds.read_points import points_kind, read_points

    check_output_file(asked.out, overwrite=asked.overwrite, inputs=[asked.file])
    cloud = read_points(asked.file, asked.layout)
    with atomic_file(asked.out) as temporary:
        write_points_npz(temporary, cloud)
    summary = {
        "out": str(asked.out),
        "kind": asked.layout or points_kind(asked.file),
        "points": len(cloud.frame),
        "frames": cloud.num_frames,
        "with_points": len(np.unique(cloud.frame)),
        "notes": cloud.notes,
    }
    return asked.report(
        summary,
        f"wrote {asked.out}: {summary['points']:,} points in {cloud.num_frames} frames ({summary['kind']});"
        f" x {_span(cloud.x_m)},"
        f" y {_span(cloud.y_m)}, z {_span(cloud.z_m)} m",
        *(f"note: {sentence}" for sentence in cloud.notes),
    )


def _span(values: Any) -> str:
    return f"{values.min():.2f} to {values.max():.2f}" if len(values) else "none"
