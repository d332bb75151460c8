"""mmweaver process: a real recording through the same processing, into the same files and pictures."""

import argparse
from pathlib import Path
from typing import Any

from mmweaver.cli.arguments import (
    add_board_options,
    add_output_options,
    add_points_option,
    add_range_options,
    add_sample_options,
    radar_of,
    source,
)
from mmweaver.cli.config_file import REQUEST_FILE, request_toml
from mmweaver.core.errors import InputError

NUM_STAGES = 7
EXAMPLES = """examples:
  mmweaver process adc_data.bin --radar radar.json --iq-order iq --tx-order 0,2,1 --out capture/
  mmweaver process capture_00000/ --out capture/
  mmweaver process sitting.bin --radar profile.cfg --range 0.3,3 --out sitting/     # breathing, heart, displacement
  mmweaver process walk.bin --radar adv.cfg --subframe 1 --antennas aop --remove-static auto --out walk/
  mmweaver process walk.bin --radar profile.cfg --board board.json --out walk/     # without the board's errors
  mmweaver process adc.npy --radar profile.cfg --axes frame,loop,tx,rx,sample --out capture/
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "process", help="take a recording through the same processing", epilog=EXAMPLES,
        description="Takes raw ADC samples of a real radar through range, Doppler, angle and CFAR.",
    )  # fmt: skip
    parser.add_argument(
        "file", type=Path, nargs="?", metavar="FILE|DIR",
        help="adc_data.bin of a DCA1000, its packets as .pcap or .pcapng, raw ADC samples as .npy, radar.npz,"
        " a HuPR, mmMesh, RF-Genesis or CubeLearn array, or a capture folder of"
        " mmwave-capture-std (radar.cfg, dca.pcap)",
    )  # fmt: skip
    recording = parser.add_argument_group("input")
    add_sample_options(recording, brought="a capture folder brings its own")
    add_range_options(recording)
    recording.add_argument(
        "--strict", action="store_true", help="refuse samples that do not fit the settings (default: a warning)"
    )
    add_board_options(recording)
    recording.add_argument(
        "--board", type=source, metavar="FILE",
        help="board.json of the board that made it (mmweaver calibrate), whose errors are taken away",
    )  # fmt: skip
    output = parser.add_argument_group("output")
    output.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for the results")
    add_points_option(output)
    output.add_argument(
        "--remove-static", choices=("auto", "mean_chirp", "mean_frame"), default="none",
        help="take static clutter away from the cube and its points: the mean over each frame's chirps, or over all"
        " frames (auto: over frames where a frame has fewer than four loops)",
    )  # fmt: skip
    output.add_argument(
        "--no-analysis", action="store_true", help="do not look for slow movement, breathing, micro-Doppler and people"
    )
    output.add_argument("--no-pictures", action="store_true", help="leave out all pictures")
    add_output_options(output)
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Processes the recording and writes the results. Raises InputError."""
    from mmweaver.cli.progress import StageBar
    from mmweaver.cli.summary import print_summary
    from mmweaver.core.output_checks import check_output_folder

    if arguments.file is None:
        raise InputError("which recording? give a file or a capture folder (see mmweaver process --help)")
    from mmweaver.result_folder import FILES

    check_output_folder(arguments.out, overwrite=arguments.overwrite, files=FILES, inputs=[arguments.file])
    with StageBar(NUM_STAGES, quiet=arguments.quiet or arguments.verbose) as bar:
        from mmweaver.core.stages import Stages
        from mmweaver.recordings.processing import process_recording

        recording = process_recording(
            arguments.file, radar_of(arguments), layout=arguments.layout, axes=arguments.axes,
            iq_order=arguments.iq_order, tx_order=arguments.tx_order, range_m=arguments.range_m,
            range_bins=arguments.range_bins, points=arguments.points, static_removal=arguments.remove_static,
            board=arguments.board,
            analyse=not arguments.no_analysis,
            strict=arguments.strict, stages=Stages(bar),
        )  # fmt: skip
        written = {REQUEST_FILE: request_toml(arguments.parser, arguments)}
        meta = recording.save(
            arguments.out, overwrite=arguments.overwrite, extra=written, pictures=not arguments.no_pictures
        )
    print_summary(arguments.out, meta, as_json=arguments.json, quiet=arguments.quiet, verbose=arguments.verbose)
    return 0
