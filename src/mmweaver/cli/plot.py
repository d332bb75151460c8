"""mmweaver plot: pictures of the features of a signal."""

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from mmweaver.cli.option_groups import Samples
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options
from mmweaver.core.output_checks import check_output_file

if TYPE_CHECKING:
    from mmweaver.viz.figure_data import FigureData

EXAMPLES = """examples:
  mmweaver plot walk/                                      # features.png: all features at four times
  mmweaver plot walk.mmw --feature rd,micro_doppler --frames 0,5,10 --remove-static mean_chirp -o walk.png
  mmweaver plot set/ --sequence 12 --feature drai,points   # of a labelled set
  mmweaver plot adc_data.bin --radar profile.cfg --feature ra
"""


@options
class Options(Samples):
    """Draws what mmweaver.signal.features computes, with axes and one scale of decibels: a row per feature, a column
    per frame.
    """

    signal: Path = option(
        "a folder of mmweaver generate or process, a .mmw file, a recording, or a labelled set",
        "SIGNAL",
        default=MISSING,
        positional=True,
    )
    feature: tuple[str, ...] | None = option(
        "rd (range-Doppler), ra (range-azimuth), re (range-elevation), drai, micro_doppler, points (default: all that"
        " the antennas resolve)",
        "NAME,...",
    )
    frames: tuple[int, ...] | None = option("at most 8 frames, from 0 on (default: four of them)", "N,N,...")
    remove_static: Literal["mean_chirp"] | None = option("rd, ra and re without each frame's mean chirp")
    sequence: int | None = option("which sequence of a labelled set (default 0)", "N")
    out: Path = option("the picture (default: features.png)", "PNG", default=Path("features.png"), short="-o")
    overwrite: bool = option("replace the picture where it exists", default=False)


def run(asked: Options) -> int:
    """Draws the features and prints the name of the picture.

    Raises:
        InputError: For a signal that cannot be read, or unknown features or frames.
    """
    check_output_file(asked.out, overwrite=asked.overwrite, inputs=[asked.signal])
    if asked.out.suffix.lower() not in ("", ".png"):
        raise InputError(f"{asked.out}: pictures are PNG files; name it {asked.out.stem}.png")
    from mmweaver.core.atomic_files import atomic_file
    from mmweaver.viz.feature_page import draw_features, features_of, frames_of

    view = _view(asked)
    features = features_of(view.cube, asked.feature)
    shown = frames_of(view.cube, asked.frames)
    with atomic_file(asked.out) as partial:
        draw_features(partial, view, features, shown, moving=asked.remove_static is not None)
    print(asked.out)
    return 0


def _view(asked: Options) -> "FigureData":
    from mmweaver.datasets.activity_store import is_activity_set, read_activity_set
    from mmweaver.signal.points import point_cloud
    from mmweaver.viz.figure_data import FigureData

    if is_activity_set(asked.signal):
        stored, number = read_activity_set(asked.signal), asked.sequence or 0
        if number >= len(stored):
            raise InputError(f"there is no sequence {number}; the set has {len(stored)}, from 0 on")
        title = f"{stored.columns['text'][number]} ({stored.columns['label_name'][number]}, sequence {number})"
        return FigureData(title=title, cube=stored.cube(number), points=stored.cloud(number))
    if asked.sequence is not None:
        raise InputError("--sequence is of a labelled set; leave it out")
    from mmweaver.evaluation.compared_sides import signals_of
    from mmweaver.recordings.read_recording import RawReading

    reading = RawReading(radar=asked.radar_name(), **asked.reading())
    signals = signals_of(asked.signal, reading, str(asked.signal))
    if len(signals) > 1:
        raise InputError(f"{asked.signal} holds {len(signals)} signals; name one, such as {signals[0].name}")
    found = signals[0]
    title = str(found.meta.get("text") or found.name)
    points = point_cloud(found.cube) if found.points is None else found.points
    return FigureData(title=title, cube=found.cube, points=points)
