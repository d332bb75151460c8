"""mmweaver points: point clouds of boards and data sets become points.npz."""

import argparse
import json
from pathlib import Path
from typing import Any

EXAMPLES = """examples:
  mmweaver points xwr68xx_log.dat -o points.npz          # the data port of a TI demo, people tracking too
  mmweaver points radar_data.csv -o points.npz           # Frame #,# Obj,X,Y,Z,Doppler,Intensity
  mmweaver points E01/S01/A01/mmwave/ -o points.npz      # frames of MM-Fi
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "points", help="read a point cloud of a board or a data set", epilog=EXAMPLES,
        description="Reads a logged point cloud and writes it as points.npz: frame, x right, y away, z up in metres,"
        " radial velocity in m/s (away +), SNR in dB and intensity where it has them.",
    )  # fmt: skip
    parser.add_argument("file", type=Path, metavar="FILE|DIR", help="the log, or a folder of frames")
    parser.add_argument(
        "--kind", metavar="NAME", help="ti_uart, csv, mmfi, radhar, npz or points (default: by the file itself)"
    )
    parser.add_argument("-o", "--out", type=Path, required=True, metavar="FILE", help="the points.npz to write")
    parser.add_argument("--overwrite", action="store_true", help="replace the file if it exists")
    parser.add_argument("--json", action="store_true", help="print a machine-readable summary on stdout")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Reads the points and writes them. Raises InputError."""
    import numpy as np

    from mmweaver.core.atomic_files import atomic_file
    from mmweaver.core.output_checks import check_output_file
    from mmweaver.formats.npz_files import write_points_npz
    from mmweaver.formats.point_clouds.read_points import points_kind, read_points

    check_output_file(arguments.out, overwrite=arguments.overwrite, inputs=[arguments.file])
    cloud = read_points(arguments.file, arguments.kind)
    with atomic_file(arguments.out) as temporary:
        write_points_npz(temporary, cloud)
    frames = int(cloud.frame.max()) + 1 if len(cloud.frame) else 0
    summary = {
        "out": str(arguments.out), "kind": arguments.kind or points_kind(arguments.file), "points": len(cloud.frame),
        "frames": frames, "with_points": len(np.unique(cloud.frame)),
    }  # fmt: skip
    if arguments.json:
        print(json.dumps(summary, indent=2))
    elif not arguments.quiet:
        print(
            f"wrote {arguments.out}: {summary['points']:,} points in {frames} frames ({summary['kind']});"
            f" x {_span(cloud.x_m)}, y {_span(cloud.y_m)}, z {_span(cloud.z_m)} m"
        )
    return 0


def _span(values: Any) -> str:
    return f"{values.min():.2f} to {values.max():.2f}" if len(values) else "none"
