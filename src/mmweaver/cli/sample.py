"""mmweaver sample: files to try the other commands with."""

from pathlib import Path

from mmweaver.cli.option_groups import Written
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver sample room/ && cd room/
  mmweaver generate --rgb rgb.png --depth depth.png --camera camera.json --text "a person walks" --out walk/
  mmweaver process empty.bin --radar profile.cfg --out empty/
  mmweaver dataset set/ --room . --activities activities.toml
  mmweaver recognise train TASK.toml --sequences 8 --out model/
"""
PICTURE, RADAR, RECORDING = "rgb.png", "profile.cfg", "empty.bin"
RECORDED_S, SEED, BOARD = 3.0, 0, "typical:1"


@options
class Options(Written):
    """Writes the bundled room (rgb.png, depth.png, camera.json), a simulated recording of it with nobody in it
    (empty.bin) and its radar (profile.cfg), activities for a data set (activities.toml) and for a recogniser
    (TASK.toml). README.txt says what each file is. The files are always the same.
    """

    out: Path = option("folder for the files, new or empty", "DIR", default=MISSING, positional=True, is_setting=False)


def run(asked: Options) -> int:
    """Writes all files or none. Raises InputError."""
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.scene.photo_files import SAMPLE_FOLDER

    bundled = sorted(file.name for file in SAMPLE_FOLDER.iterdir() if file.is_file() and file.suffix != ".webp")
    names = sorted([*bundled, PICTURE, RECORDING])
    check_output_folder(asked.out, overwrite=asked.overwrite, files=names)
    _write(asked.out, SAMPLE_FOLDER, bundled, overwrite=asked.overwrite)
    return asked.report({"out": str(asked.out), "files": names}, f"wrote {asked.out}: {', '.join(names)}")


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
