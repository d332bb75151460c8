"""Advice about files that are read and written: recordings, radars, results, compressed files, exports."""

import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np

from mmweaver.cli.main import main
from mmweaver.core.boards import ANTENNAS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.inr import fit
from mmweaver.io.dca1000 import upright, write_bin
from mmweaver.io.radar_options import RadarOptions
from tests.advice.harness import Row, Step, Try, Words, add, drop, edit, first, flag, instead, plus
from tests.captures import counts, packets_of, pcap_of, radar_of_cfg
from tests.cubes import point_cube
from tests.io.test_peer_arrays import hupr_array, simulated_frame
from tests.recordings.test_plausibility import RADAR, room

PROCESS = "process {iq} --radar {radar} --no-pictures --no-analysis --out out"
COMPRESS = "compress {walk}/radar.npz -o out.mmw"


def _written(name: str, content: str = "mine") -> None:
    Path(name).parent.mkdir(parents=True, exist_ok=True)
    Path(name).write_text(content)


def _as_npy() -> None:
    words = np.fromfile("numbers.bin", "<f4").reshape(2, 16, 3, 4, 64, 2)
    np.save("numbers.npy", (words[..., 0] + 1j * words[..., 1]).astype(np.complex64))


def _field() -> None:
    fit(point_cube(num_frames=2), "scatterers", num_values=1_500).save("field.safetensors")


def _of_the_field(words: Words, message: str) -> list[Words]:
    return [[words[0], "field.safetensors", *words[2:]]]


def _floats() -> None:
    rng = np.random.default_rng(0)
    noise = rng.normal(size=(2, 16, 3, 4, 64, 2)).view(complex)[..., 0]
    tone = np.exp(2j * np.pi * 0.1 * np.arange(64)) + 0.01 * noise
    tone.astype(np.complex64).tofile("numbers.bin")


def _recorded(adc: AdcCube, config: RadarConfig, *, wrong: RadarConfig) -> None:
    write_bin(Path("adc.bin"), adc, counts_per_unit=1.0)
    Path("radar.json").write_text(config.to_json())
    Path("wrong.json").write_text(wrong.to_json())


def _more_loops() -> None:
    _recorded(room(RADAR, 20), RADAR, wrong=replace(RADAR, num_loops=32, frame_period_s=2 * RADAR.frame_period_s))


def _fewer_transmitters() -> None:
    wrong = replace(RADAR, tx_position_m=RADAR.tx_position_m[:2], tx_order=(0, 1), num_loops=24)
    _recorded(room(RADAR), RADAR, wrong=wrong)


def _another_board() -> None:
    aop = RadarOptions(antennas=ANTENNAS["aop"]).applied(RADAR)
    adc = room(aop)
    isk = RadarOptions(antennas=ANTENNAS["isk"]).applied(aop)
    _recorded(replace(adc, samples=upright(adc.samples, aop)), aop, wrong=isk)


def _packets() -> None:
    config = radar_of_cfg(Path())
    Path("dca.pcap").write_bytes(pcap_of(packets_of(Path(), counts(config, 8))))
    Path("radar.json").write_text(config.to_json())
    Path("wrong.json").write_text(replace(config, frame_period_s=2 * config.frame_period_s).to_json())


def _hupr_array() -> None:
    np.save("frame.npy", hupr_array(simulated_frame()))


def _two_radars() -> None:
    _written("texts.txt", "a person waves\na person stands\n")
    words = ["generate", "--demo", "--texts", "texts.txt", "--frames", "1", "--no-pictures", "--quiet", "--bin"]
    assert main([*words, "--out", "level"]) == 0
    for number in (0, 1):
        Path(f"level/{number:04d}").rename(f"level/radar_{number + 1}")


def _of_two_transmitters() -> None:
    config = radar_of_cfg(Path())
    write_bin(Path("adc.bin"), counts(config), iq_order="qi", counts_per_unit=1.0)
    words = ["process", "adc.bin", "--radar", "made.cfg", "--no-pictures", "--no-analysis", "--quiet"]
    assert main([*words, "--out", "other"]) == 0
    Path("adc.bin").rename("other/adc_data.bin")


OTHER_RADAR = "process adc.bin --radar wrong.json --no-pictures --no-analysis --out out --overwrite"
IN_FRONT = "generate --demo --frames 1 --no-pictures --out made --text 'a person waves' --bin"


def generated(said: str, *more: str, then: Try) -> Try:
    """A result is generated with these options, as the message advises, and taken in place of the refused one."""

    def changed(words: Words, message: str) -> list[Step]:
        for option in more:
            assert option in message or option == "hupr", f"{option} is not advised: {message}"
        return [[*shlex.split(IN_FRONT), *more], *then(words, message)]

    return changed


ROWS = (
    # recordings
    Row(
        ": the frames of the recording probably have",
        OTHER_RADAR,
        (instead("--radar is probably another", "wrong.json", "radar.json"),),
        before=_more_loops,
    ),
    Row(
        "chirps one loop (",
        OTHER_RADAR,
        (instead("--radar is probably not the radar", "wrong.json", "radar.json"),),
        before=_fewer_transmitters,
    ),
    Row(
        "try --radar-set antennas=□, or another --radar",
        OTHER_RADAR,
        (
            plus("--radar-set antennas=", "--radar-set", "antennas=aop"),
            instead("or another --radar", "wrong.json", "radar.json"),
        ),
        before=_another_board,
    ),
    Row(
        "the packets of a frame came every",
        "process dca.pcap --radar wrong.json --no-pictures --no-analysis --out out --overwrite",
        (instead("--radar is probably not the radar", "wrong.json", "radar.json"),),
        before=_packets,
    ),
    Row(
        "cannot have made HuPR's arrays",
        "process frame.npy --layout hupr --radar mmmesh --no-pictures --no-analysis --out out",
        (drop("--radar"), add("--radar", "hupr")),
        before=_hupr_array,
    ),
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
        (plus("--radar-set lanes=2", "--radar-set", "lanes=2"), instead("another --radar", "--radar-set lanes=4")),
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
        (add("--layout"), plus("or rf_genesis", "--layout", "rf_genesis")),
    ),
    Row("name its kind with --layout", "points {points_log} -o out.npz", (add("--layout", "csv"),)),
    # radars
    Row(
        "or a .json from: mmweaver radar awr1843 --json",
        "radar unknown",
        (first("mmweaver radar awr1843 --json > radar.json", instead("or a .json", "unknown", "radar.json")),),
    ),
    Row(
        "is no radar that is known: neither a radar.json (mmweaver radar awr1843 --json > radar.json)",
        "radar empty.json",
        (first("mmweaver radar awr1843 --json > radar.json", instead("radar.json", "empty.json", "radar.json")),),
        before=lambda: _written("empty.json", "[]"),
    ),
    Row(
        "it has □ sub-frames; choose one of 0 to □: --radar-set subframe=",
        "radar {sub_frames}",
        (plus("--radar-set subframe=N", "--radar-set", "subframe=0"),),
    ),
    Row(
        "it has one plain frame and no sub-frames", "radar {best_range} --radar-set subframe=0", (drop("--radar-set"),)
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
        "firmware points are for TI radars",
        "generate --demo --frames 1 --no-pictures --out out --radar {two_loops} --points firmware",
        (add("--points"),),
    ),
    # what is written
    Row(
        "exists; choose another name or allow it with --overwrite",
        "points {points} -o out.npz",
        (instead("choose another name", "out.npz", "other.npz"), flag("--overwrite")),
        before=lambda: _written("out.npz"),
    ),
    Row(
        "exists and is not empty; choose another --out",
        PROCESS,
        (instead("choose another --out", "out", "other"), flag("--overwrite")),
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
    Row("say how small with --bytes", COMPRESS, (add("--bytes", "4000"), add("--quality", "30"))),
    Row("--append adds to a .mmw file", f"{COMPRESS} --append --quality 30 --overwrite", (drop("--overwrite"),)),
    Row(
        "a cube has --quality, and is stored exactly",
        "compress {walk}/radar.npz -o out.mmwl --lossless",
        (instead("a cube has --quality", "out.mmwl --lossless", "out.mmw --quality 30"),),
    ),
    Row(
        "mmweaver compress CAPTURE.npz --quality 30 -o OUT.mmw",
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
        "□ is □; choose another --out",
        "generate --demo --frames 1 --no-pictures --out out --text 'a person waves'",
        (instead("choose another --out", "out", "other"),),
        before=lambda: _written("out"),
    ),
    Row(
        "exists; choose another name, or add --overwrite",
        "export {walk} --to mat --out walk.mat",
        (instead("choose another name", "walk.mat", "other.mat"), flag("--overwrite")),
        before=lambda: _written("walk.mat"),
    ),
    Row(
        "needs raw samples, which a set does not keep",
        "export a_set --to rf_genesis --out out",
        (generated("generate results", "--bin", then=instead("with --bin", "a_set", "made")),),
        before=lambda: _written("a_set/plan.json", "{}"),
    ),
    Row(
        "□ holds no □, which this format needs; generate it with --bin",
        "export {processed} --to rf_genesis --out out",
        (generated("generate it", "--bin", then=instead("with --bin", "{processed}", "made")),),
    ),
    Row(
        "HuPR's arrays have 3 TX, 4 RX",
        "export other --to hupr --out out",
        (generated("generate", "--radar", "hupr", then=instead("with --radar hupr", "other", "made")),),
        before=_of_two_transmitters,
    ),
    Row(
        "HuPR's second radar is rolled by 90 degrees",
        "export level --to hupr --out out",
        (
            generated(
                "generate",
                "--radar",
                "hupr",
                "--radar-pose",
                "0,0,0,0,0",
                "--radar-pose",
                "0.1,0,0,0,0,90",
                then=instead("generate with", "level", "made"),
            ),
        ),
        before=_two_radars,
    ),
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
    Row(
        "□ is a file; give a folder of mmweaver generate or mmweaver process",
        "view {rgb} -o page.html --no-browser",
        (instead("give a folder of mmweaver generate", "{rgb}", "{walk}"),),
    ),
    Row("where to write the signal of", "sample field.safetensors --finer 2,1,1", (add("--out", "finer.npz"),), _field),
    Row("is no field; give a .safetensors", "sample room --finer 2,1,1 --out a.npz", (_of_the_field,), _field),
    Row("holds no field; give a file", "sample {weights} --finer 2,1,1 --out a.npz", (_of_the_field,), _field),
    Row(
        "are of networks; leave them out",
        "fit {walk}/radar.npz --field scatterers --steps 5 --values 60000 -o a.safetensors",
        (drop("--steps"),),
    ),
    Row(
        "--sequence is of a set; leave it out",
        "fit {walk}/radar.npz --field scatterers --sequence 1 --values 60000 -o a.safetensors",
        (drop("--sequence"),),
    ),
)
