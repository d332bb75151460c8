"""Advice about files that are read and written: recordings, radars, results, compressed files, exports."""

from pathlib import Path

import numpy as np

from tests.advice.harness import Row, add, drop, edit, first, flag, instead, plus

PROCESS = "process {iq} --radar {radar} --no-pictures --no-analysis --out out"
COMPRESS = "compress {walk}/radar.npz -o out.mmw"


def _written(name: str, content: str = "mine") -> None:
    Path(name).parent.mkdir(parents=True, exist_ok=True)
    Path(name).write_text(content)


def _as_npy() -> None:
    words = np.fromfile("numbers.bin", "<f4").reshape(2, 16, 3, 4, 64, 2)
    np.save("numbers.npy", (words[..., 0] + 1j * words[..., 1]).astype(np.complex64))


def _floats() -> None:
    rng = np.random.default_rng(0)
    noise = rng.normal(size=(2, 16, 3, 4, 64, 2)).view(complex)[..., 0]
    tone = np.exp(2j * np.pi * 0.1 * np.arange(64)) + 0.01 * noise
    tone.astype(np.complex64).tofile("numbers.bin")


ROWS = (
    # recordings
    Row(
        "which recording? give a file",
        "process --radar {radar} --no-pictures --out out",
        (
            instead("give a file", "process", "process {iq}"),
            first("mmweaver process --help", plus("give a file", "{iq}")),
        ),
    ),
    Row("only a capture folder and", "process {walk}/adc_data.bin --no-pictures --out out", (add("--radar"),)),
    Row(
        "which radar recorded it? give --radar, for example --radar awr1843",
        "compress {walk}/adc_data.bin -o a.mmwl --lossless",
        (add("--radar"),),
    ),
    Row(
        "energy at negative beat frequencies",
        "process {interleaved} --radar {radar} --overwrite --no-pictures --no-analysis --out out",
        (add("--iq-order"),),
    ),
    Row("energy at negative beat frequencies", f"{PROCESS} --overwrite --iq-order qi", (add("--iq-order"),)),
    Row(
        "the echoes of a chirp gather at fewer ranges",
        f"{PROCESS} --overwrite --radar-set lanes=4",
        (
            plus("--radar-set lanes=2", "--radar-set", "lanes=2"),
            instead("another --radar", "--radar-set lanes=4"),
        ),
    ),
    Row("the transmitters fit the static echoes to", f"{PROCESS} --overwrite --tx-order 2,0,1", (add("--tx-order"),)),
    Row(
        "save it as .npy and give --layout",
        "process numbers.bin --radar {radar} --overwrite --no-pictures --no-analysis --out out",
        (
            edit(
                "save it as .npy",
                _as_npy,
                instead("give --layout", "numbers.bin", "numbers.npy --layout frame,loop,tx,rx,sample"),
            ),
        ),
        before=_floats,
    ),
    Row(
        "the file is truncated or --radar is not",
        "process {iq} --radar awr1843 --no-pictures --out out",
        (instead("--radar is not the radar", "awr1843", "{radar}"),),
    ),
    Row(
        "give a folder that mmweaver process wrote",
        "process {nothing} --radar {radar} --no-pictures --out out",
        (instead("give a folder that mmweaver process wrote", "{nothing} --radar {radar}", "{processed}"),),
    ),
    Row(
        "name its axes, for example --layout",
        "process {samples} --radar {radar} --no-pictures --no-analysis --out out",
        (add("--layout"),),
    ),
    Row(
        "give --layout mmmesh or rf_genesis",
        "process {mmmesh} --radar mmmesh --no-pictures --no-analysis --out out",
        (
            add("--layout"),
            plus("or rf_genesis", "--layout", "rf_genesis"),
        ),
    ),
    Row("name its kind with --layout", "points {points_log} -o out.npz", (add("--layout", "csv"),)),
    # radars
    Row(
        "or a .json from: mmweaver radar awr1843 --json",
        "radar unknown",
        (first("mmweaver radar awr1843 --json > radar.json", instead("or a .json", "unknown", "radar.json")),),
    ),
    Row(
        "the radar file holds no object",
        "radar empty.json",
        (first("mmweaver radar awr1843 --json > radar.json", instead("make one with", "empty.json", "radar.json")),),
        before=lambda: _written("empty.json", "[]"),
    ),
    Row(
        "it has □ sub-frames; choose one of 0 to □: --radar-set subframe=",
        "radar {sub_frames}",
        (plus("--radar-set subframe=N", "--radar-set", "subframe=0"),),
    ),
    Row(
        "it has one plain frame (frameCfg)",
        "radar {best_range} --radar-set subframe=0",
        (drop("--radar-set"),),
    ),
    Row(
        "has no sub-frames; leave out --radar-set subframe=",
        "radar awr1843 --radar-set subframe=0",
        (drop("--radar-set"),),
    ),
    Row(
        "which cannot be read; describe its chirp in a radar.json",
        "radar {other_device}",
        (
            first(
                "mmweaver radar iwr6843isk --json > radar.json",
                instead("in a radar.json", "{other_device}", "radar.json"),
            ),
        ),
    ),
    Row(
        "another board: --radar-set antennas=",
        "radar {made} --radar-set antennas=boost1642",
        (plus("--radar-set antennas=", "--radar-set", "antennas=ods"),),
    ),
    Row(
        "has no cfarCfg",
        "generate --demo --frames 1 --no-pictures --out out --radar {made} --points firmware",
        (add("--points"),),
    ),
    Row(
        "firmware points are for TI radars",
        "generate --demo --frames 1 --no-pictures --out out --radar {two_loops} --points firmware",
        (add("--points"),),
    ),
    # what is written
    Row(
        "exists; choose another name or allow it with --overwrite",
        "points {points} -o out.npz",
        (
            instead("choose another name", "out.npz", "other.npz"),
            flag("--overwrite"),
        ),
        before=lambda: _written("out.npz"),
    ),
    Row(
        "exists and is not empty; choose another --out",
        PROCESS,
        (
            instead("choose another --out", "out", "other"),
            flag("--overwrite"),
        ),
        before=lambda: _written("out/meta.json"),
    ),
    Row(
        "is a folder where a file is to be written",
        f"{PROCESS} --overwrite",
        (instead("choose another --out", "out", "other"),),
        before=lambda: Path("out/radar.npz").mkdir(parents=True),
    ),
    Row(
        "belongs to the input and would be replaced",
        "process {processed}/radar.npz --no-pictures --out {processed} --overwrite",
        (instead("choose another --out", "--out {processed}", "--out other"),),
    ),
    Row(
        "cannot be written, for □ is not a folder",
        f"{PROCESS}/below/it",
        (instead("choose another --out", "out/below/it", "other"),),
        before=lambda: _written("out"),
    ),
    # compressed files
    Row(
        "say how small with --bytes",
        COMPRESS,
        (
            add("--bytes", "4000"),
            add("--quality", "30"),
        ),
    ),
    Row("--append adds to a .mmw file", f"{COMPRESS} --append --quality 30 --overwrite", (drop("--overwrite"),)),
    Row(
        "a cube has --quality, and is stored exactly",
        "compress {walk}/radar.npz -o out.mmwl --lossless",
        (instead("a cube has --quality", "out.mmwl --lossless", "out.mmw --quality 30"),),
    ),
    Row(
        "is no .mmw file; make one with",
        "info notes.mmw",
        (
            edit(
                "make one with",
                lambda: Path("notes.mmw").unlink(),
                first("mmweaver compress", **{"CAPTURE.npz": "{walk}/radar.npz", "OUT.mmw": "notes.mmw"}),
            ),
        ),
        before=lambda: Path("notes.mmw").write_bytes(bytes(60)),
    ),
    Row(
        "holds packed raw samples",
        "plot {packed} -o out.png --radar {radar}",
        (
            first(
                "mmweaver decompress",
                instead("unpack it first", "{packed}", "back.bin"),
                **{"FILE": "{packed}", "ADC_DATA.bin": "back.bin"},
            ),
        ),
    ),
    # results
    Row(
        "give a result folder, --to FORMAT and --out DIR",
        "export {walk}",
        (first("mmweaver export", plus("--to FORMAT and --out DIR", "--to", "mat", "--out", "out")),),
    ),
    Row(
        "holds no result; give a folder of mmweaver generate",
        "export {nothing} --to mat --out out",
        (
            instead("give a folder of mmweaver generate", "{nothing}", "{walk}"),
            instead("or mmweaver process", "{nothing}", "{processed}"),
        ),
    ),
    Row(
        "a folder of mmweaver generate or mmweaver process",
        "export absent --to mat --out out",
        (instead("give a folder of mmweaver generate", "absent", "{walk}"),),
    ),
    Row(
        "holds no radar.npz; give a folder of",
        "view {nothing} -o page.html --no-browser",
        (instead("give a folder of mmweaver generate", "{nothing}", "{walk}"),),
    ),
    Row("--sequence is of a labelled set", "plot {walk} --sequence 1 -o out.png", (drop("--sequence"),)),
)
