"""mmweaver fit: a field of a signal, a network or scatterers, that can be sampled anywhere."""

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from mmweaver.cli.option_groups import Samples, Written
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options

if TYPE_CHECKING:
    from mmweaver.core.records import RadarCube

EXAMPLES = """examples:
  mmweaver fit walk/ --out walk.safetensors                        # an INR of 10,018 values: -25 dB and better
  mmweaver fit walk/ --field scatterers --out walk.safetensors     # the same number of values, nearer and faster
  mmweaver fit walk/ --preset paper --out paper.safetensors        # the paper's network and recipe, as written
  mmweaver fit set/ --sequence 3 --values 5000 --out third.safetensors
  mmweaver sample walk.safetensors --finer 2,2,1 --out finer.npz
"""


@options
class Options(Written, Samples):
    """Fits a field to a signal: a function of continuous coordinates with few values. mmweaver sample reads it at any
    of them. A picture next to the field shows signal, field and the error during the fit.
    """

    signal: Path = option(
        "a folder of mmweaver generate or process, radar.npz, a .mmw file, a recording, or a set with --sequence",
        "SIGNAL",
        default=MISSING,
        positional=True,
    )
    out: Path = option("the field", "SAFETENSORS", default=MISSING, short="-o", is_setting=False)
    field: Literal["modulated", "base", "scatterers"] = option(
        "modulated: the paper's proposed INR, base: its base INR over (t, r, d, a), scatterers: points with the radar's"
        " own response",
        default="modulated",
    )
    values: int = option("most values of the field", "N", default=10_018)
    preset: Literal["working", "paper"] = option(
        "how a network is built and fitted: as works best, or as the paper states", default="working"
    )
    steps: int | None = option("steps of a network (default 600; base 2000, preset paper 500)", "N")
    seed: int = option("seed of a network's initial weights and samples", "N", default=0)
    sequence: int | None = option("which sequence of a set (default 0)", "N")


def run(asked: Options) -> int:
    """Fits a field and writes it with its picture.

    Raises:
        InputError: For a signal that cannot be read or fitted, or an output that cannot be written.
    """
    from mmweaver.core.output_checks import check_output_file

    picture = asked.out.with_suffix(".png")
    if asked.out.suffix != ".safetensors":
        raise InputError(f"{asked.out}: fields are .safetensors files; name it {asked.out.stem}.safetensors")
    for file in (asked.out, picture):
        check_output_file(file, overwrite=asked.overwrite, inputs=[asked.signal])
    for name in ("values", "steps"):
        if (getattr(asked, name) or 1) < 1:
            raise InputError(f"--{name} must be 1 or more, not {getattr(asked, name)}")
    if asked.field == "scatterers" and (asked.steps or asked.preset == "paper"):
        raise InputError("--steps and --preset paper are of networks; leave them out with --field scatterers")
    cube = _cube(asked)
    field, curve, seconds = _fitted(asked, cube)
    from mmweaver.core.atomic_files import atomic_files
    from mmweaver.inr.fit_picture import draw_fit, errors_db

    again = field.cube()
    errors = errors_db(again, cube)
    with atomic_files(asked.out, picture) as (file, drawing):
        field.save(file)
        draw_fit(drawing, cube, again, curve, f"{asked.field}, {field.num_values:,} values")
    summary = {
        "out": str(asked.out), "picture": str(picture), "field": asked.field, "values": field.num_values, **errors,
        "seconds": round(seconds, 1),
    }  # fmt: skip
    text = (
        f"wrote {asked.out}: {field.num_values:,} values for {cube.values.size * 2:,}, error"
        f" {errors['error_db']:.1f} dB ({errors['error_active_db']:.1f} dB where there is signal), in {seconds:.0f} s;"
        f" and {picture}"
    )
    return asked.report(summary, text)


def _fitted(asked: Options, cube: "RadarCube") -> tuple[Any, list[tuple[int, float]], float]:
    from dataclasses import replace

    from tqdm import tqdm

    from mmweaver.inr import PAPER, FitOptions, fit

    chosen = replace(PAPER if asked.preset == "paper" else FitOptions(), seed=asked.seed)
    if asked.steps is not None:
        chosen = replace(chosen, steps=asked.steps)
    curve: list[tuple[int, float]] = []
    start = time.monotonic()
    with tqdm(unit="step", desc="fit", leave=False, disable=asked.quiet or asked.json or None) as bar:

        def show(step: int, steps: int, error_db: float) -> None:
            bar.total = steps
            bar.update(step - bar.n)
            bar.set_postfix(error=f"{error_db:.1f} dB")
            curve.append((step, error_db))

        field = fit(cube, asked.field, num_values=asked.values, options=chosen, progress=show)
    return field, curve, time.monotonic() - start


def _cube(asked: Options) -> "RadarCube":
    from mmweaver.datasets.room_sequences import is_set, read_labelled
    from mmweaver.evaluation.compared_sides import signals_of
    from mmweaver.recordings.read_recording import RawReading

    if is_set(asked.signal):
        stored, number = read_labelled(asked.signal), asked.sequence or 0
        if not 0 <= number < len(stored):
            raise InputError(f"there is no sequence {number}; the set has {len(stored)}, from 0 on")
        return stored.cube(number)
    if asked.sequence is not None:
        raise InputError("--sequence is of a set; leave it out")
    found = signals_of(asked.signal, RawReading(radar=asked.radar_name(), **asked.reading()), str(asked.signal))
    if len(found) > 1:
        raise InputError(f"{asked.signal} holds {len(found)} signals; name one, such as {found[0].name}")
    return found[0].cube
