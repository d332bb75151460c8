"""mmweaver plot: pictures of the features of a signal."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import add_board_options, add_sample_options, radar_of, whole
from mmweaver.core.errors import InputError
from mmweaver.core.output_checks import check_output_file

if TYPE_CHECKING:
    from mmweaver.figures.figure_data import FigureData

EXAMPLES = """examples:
  mmweaver plot walk/                                      # features.png: all features at four times
  mmweaver plot walk.mmw --feature rd,micro_doppler --frames 0,5,10 --moving -o walk.png
  mmweaver plot set/ --sequence 12 --feature drai,points   # of a labelled set
  mmweaver plot adc_data.bin --radar profile.cfg --feature ra
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "plot", help="draw the features of a signal, as recognisers take them", epilog=EXAMPLES,
        description="Draws what mmweaver.features computes, with axes and one scale of decibels: a row for each"
        " feature, a column for each frame.",
    )  # fmt: skip
    parser.add_argument(
        "signal", type=Path, metavar="SIGNAL",
        help="a folder of mmweaver generate or process, a .mmw file, a recording, or a labelled set",
    )  # fmt: skip
    parser.add_argument(
        "--feature", metavar="NAME,...",
        help="rd (range-Doppler), ra (range-azimuth), re (range-elevation), drai, micro_doppler, points (default: all"
        " that the antennas resolve)",
    )  # fmt: skip
    parser.add_argument("--frames", metavar="N,N,...", help="at most 8 frames, from 0 on (default: four of them)")
    parser.add_argument("--moving", action="store_true", help="rd, ra and re without each frame's mean chirp")
    parser.add_argument("--sequence", type=whole, metavar="N", help="which sequence of a labelled set (default 0)")
    parser.add_argument("-o", "--out", type=Path, default=Path("features.png"), metavar="PNG", help="the picture")
    parser.add_argument("--overwrite", action="store_true", help="replace the picture where it exists")
    raw = parser.add_argument_group("raw samples, which do not bring their radar")
    add_sample_options(raw)
    add_board_options(raw, rare=True)
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Draws and prints the name of the picture. Raises InputError."""
    check_output_file(arguments.out, overwrite=arguments.overwrite, inputs=[arguments.signal])
    if arguments.out.suffix.lower() not in ("", ".png"):
        raise InputError(f"{arguments.out}: pictures are PNG files; name it {arguments.out.stem}.png")
    frames = None if arguments.frames is None else _numbers(arguments.frames)
    from mmweaver.core.atomic_files import atomic_file
    from mmweaver.figures.feature_page import draw_features, features_of, frames_of

    view = _view(arguments)
    features = features_of(view.cube, None if arguments.feature is None else arguments.feature.split(","))
    shown = frames_of(view.cube, frames)
    with atomic_file(arguments.out) as partial:
        draw_features(partial, view, features, shown, moving=arguments.moving)
    print(arguments.out)
    return 0


def _view(arguments: argparse.Namespace) -> "FigureData":
    from mmweaver.datasets.activity_store import is_activity_set, read_activity_set
    from mmweaver.dsp.points import point_cloud
    from mmweaver.figures.figure_data import FigureData

    if is_activity_set(arguments.signal):
        stored, number = read_activity_set(arguments.signal), arguments.sequence or 0
        if number >= len(stored):
            raise InputError(f"there is no sequence {number}; the set has {len(stored)}, from 0 on")
        title = f"{stored.columns['text'][number]} ({stored.columns['label_name'][number]}, sequence {number})"
        return FigureData(title=title, cube=stored.cube(number), points=stored.cloud(number))
    if arguments.sequence is not None:
        raise InputError("--sequence is of a labelled set; leave it out")
    from mmweaver.comparison.compared_sides import signals_of
    from mmweaver.recordings.read_recording import RawReading

    reading = RawReading(
        radar=radar_of(arguments), layout=arguments.layout, axes=arguments.axes, iq_order=arguments.iq_order,
        tx_order=arguments.tx_order,
    )  # fmt: skip
    signals = signals_of(arguments.signal, reading, str(arguments.signal))
    if len(signals) > 1:
        raise InputError(f"{arguments.signal} holds {len(signals)} signals; name one, such as {signals[0].name}")
    found = signals[0]
    title = str(found.meta.get("text") or found.name)
    points = point_cloud(found.cube) if found.points is None else found.points
    return FigureData(title=title, cube=found.cube, points=points)


def _numbers(text: str) -> list[int]:
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"--frames are numbers such as 0,5,10, not {text!r}") from None
