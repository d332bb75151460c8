"""mmweaver sample: files to try the other commands with; or the signal of a field at other coordinates."""

from pathlib import Path

from mmweaver.cli.option_groups import Written
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver sample room/ && cd room/
  mmweaver generate --rgb rgb.png --depth depth.png --camera camera.json --text "a person walks" --out walk/
  mmweaver process empty.bin --radar profile.cfg --out empty/
  mmweaver dataset set/ --room . --activities activities.toml
  mmweaver recognise train TASK.toml --sequences 8 --out model/
  mmweaver sample walk.safetensors --finer 2,2,1 --out finer.npz      # a field of mmweaver fit, or a .mmw file
"""
PICTURE, RADAR, RECORDING = "rgb.png", "profile.cfg", "empty.bin"
RECORDED_S, SEED, BOARD = 3.0, 0, "typical:1"
FIELDS = (".safetensors", ".mmw")


@options
class Options(Written):
    """Writes the bundled room (rgb.png, depth.png, camera.json), a simulated recording of it with nobody in it
    (empty.bin) and its radar (profile.cfg), activities for a data set (activities.toml) and for a recogniser
    (TASK.toml). README.txt says what each file is. The files are always the same. Given a field of mmweaver fit or a
    .mmw file instead of a folder, writes its signal, at finer coordinates where asked for.
    """

    place: Path = option(
        "folder for the files, new or empty; or a field to sample, .safetensors or .mmw", "DIR|FIELD", default=MISSING,
        positional=True, is_setting=False,
    )  # fmt: skip
    out: Path | None = option("the signal of a field", "NPZ", short="-o", is_setting=False, group="of a field")
    finer: tuple[float, float, float] | None = option(
        "how many times finer along range, Doppler and antennas (default 1,1,1)", "R,D,A"
    )


def run(asked: Options) -> int:
    """Writes all files or none. Raises InputError."""
    if asked.place.suffix.lower() in FIELDS or asked.place.is_file():
        return _sample_field(asked)
    if asked.out or asked.finer:
        raise InputError(f"{asked.place} is no field; give a .safetensors file of mmweaver fit, or a .mmw file")
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.scene.photo_files import SAMPLE_FOLDER

    bundled = sorted(file.name for file in SAMPLE_FOLDER.iterdir() if file.is_file() and file.suffix != ".webp")
    names = sorted([*bundled, PICTURE, RECORDING])
    check_output_folder(asked.place, overwrite=asked.overwrite, files=names)
    _write(asked.place, SAMPLE_FOLDER, bundled, overwrite=asked.overwrite)
    return asked.report({"out": str(asked.place), "files": names}, f"wrote {asked.place}: {', '.join(names)}")


def _sample_field(asked: Options) -> int:
    """Samples a field and writes its cube; with the radar next to it where the cube has the radar's own shape."""
    from mmweaver.core.atomic_files import atomic_file
    from mmweaver.core.output_checks import check_output_file
    from mmweaver.inr import load
    from mmweaver.io.npz_files import write_radar_npz

    if asked.out is None:
        raise InputError(f"where to write the signal of {asked.place}? give --out FILE.npz")
    radar = asked.out.with_name("radar.json")
    check_output_file(asked.out, overwrite=asked.overwrite, inputs=[asked.place])
    field = load(asked.place)
    cube = field.on_grid(*(asked.finer or ()))
    has_radar = cube.grid.shape == field.grid.shape and not radar.exists()
    with atomic_file(asked.out) as partial:
        write_radar_npz(partial, cube)
    if has_radar:
        with atomic_file(radar) as partial:
            partial.write_text(cube.config.to_json(), encoding="utf-8")
    shape = " x ".join(map(str, cube.values.shape))
    summary = {"out": str(asked.out), "shape": list(cube.values.shape), "values": field.num_values}
    return asked.report(summary, f"wrote {asked.out}: {shape} cells of {field.num_values:,} values")


def _write(out: Path, source: Path, bundled: list[str], *, overwrite: bool) -> None:
    import shutil

    from PIL import Image

    from mmweaver.core.atomic_files import staged_folder
    from mmweaver.scene.photo_files import sample_photo

    with staged_folder(out, overwrite=overwrite) as stage:
        for name in bundled:
            shutil.copyfile(source / name, stage / name)
        Image.fromarray(sample_photo()[0].rgb).save(stage / PICTURE)
        _record_empty_room(stage)


def _record_empty_room(folder: Path) -> None:
    """Simulates RECORDED_S seconds of the empty bundled room, by the radar in the folder."""
    from mmweaver.io.dca1000 import write_bin
    from mmweaver.weaver.front_door import Weaver

    weaver = Weaver("physics", radar=folder / RADAR)
    found = weaver.generate(weaver.sample_room(), "nobody", seconds=RECORDED_S, seed=SEED, keep_adc=True, board=BOARD)
    assert found.adc is not None
    write_bin(folder / RECORDING, found.adc, counts_per_unit=found.adc.scale / found.adc.config.adc_count_sqrt_mw)
