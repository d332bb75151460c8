"""mmweaver process: a real recording in, the same files and pictures out."""

import argparse
from pathlib import Path
from typing import Any

from mmweaver.cli.arguments import add_layout_options, add_output_options, add_points_option

NUM_STAGES = 6
EXAMPLES = """examples:
  mmweaver process adc_data.bin --radar radar.json --iq-order iq --tx-order 0,2,1 --out capture/
  mmweaver process capture_00000/ --out capture/
  mmweaver process adc.npy --radar profile.cfg --axes frame,loop,tx,rx,sample --out capture/
"""


def add_verb(verbs: Any) -> None:
    """Declares the verb and its options."""
    parser = verbs.add_parser(
        "process", help="take a recording through the same processing", epilog=EXAMPLES,
        description="Takes raw ADC samples of a real radar through range, Doppler, angle and CFAR.",
    )  # fmt: skip
    parser.add_argument(
        "file", type=Path, metavar="FILE|DIR",
        help="adc_data.bin of a DCA1000, raw ADC samples as .npy, radar.npz, a HuPR, mmMesh or RF-Genesis array, or a"
        " capture folder of mmwave-capture-std (radar.cfg, dca.pcap)",
    )  # fmt: skip
    parser.add_argument(
        "--radar", metavar="NAME|FILE", help="preset, TI .cfg or radar.json (a capture folder brings its own)"
    )
    parser.add_argument("--axes", metavar="NAMES", help="axes of the .npy in their order: frame,loop,tx,rx,sample")
    parser.add_argument(
        "--layout", metavar="NAME", help="whose .npy it is: hupr (a frame or a folder of them), mmmesh, rf_genesis"
    )
    add_points_option(parser)
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for the results")
    add_layout_options(parser)
    add_output_options(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Processes the recording and writes the results. Raises InputError."""
    from mmweaver.cli.progress import StageBar
    from mmweaver.cli.summary import print_summary
    from mmweaver.core.atomic_files import check_output_folder

    check_output_folder(arguments.out, overwrite=arguments.overwrite)
    with StageBar(NUM_STAGES, quiet=arguments.quiet) as bar:
        from mmweaver.core.stages import Stages
        from mmweaver.recordings.processing import process_recording

        recording = process_recording(
            arguments.file, arguments.radar, layout=arguments.layout, axes=arguments.axes,
            iq_order=arguments.iq_order, tx_order=arguments.tx_order, points=arguments.points, stages=Stages(bar),
        )  # fmt: skip
        meta = recording.save(arguments.out, overwrite=arguments.overwrite)
    print_summary(arguments.out, meta, as_json=arguments.json, quiet=arguments.quiet)
    return 0
