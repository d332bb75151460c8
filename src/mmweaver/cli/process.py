"""mmweaver process: a real recording through the same processing, into the same files and pictures."""

import shutil
from functools import partial
from pathlib import Path
from typing import ClassVar, Literal

from mmweaver.cli.arguments import REQUEST_FILE, request_toml
from mmweaver.cli.option_groups import PointChoice, Ranges, Samples, Written
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, Source, option, options

NUM_STAGES = 7
EXAMPLES = """examples:
  mmweaver process adc_data.bin --radar radar.json --iq-order iq --tx-order 0,2,1 --out capture/
  mmweaver process capture_00000/ --out capture/
  mmweaver process sitting.bin --radar profile.cfg --range 0.3,3 --out sitting/     # breathing, heart, displacement
  mmweaver process walk.bin --radar adv.cfg --radar-set subframe=1 --remove-static auto --out walk/
  mmweaver process walk.bin --radar profile.cfg --board board.json --out walk/     # without the board's errors
  mmweaver process adc.npy --radar profile.cfg --layout frame,loop,tx,rx,sample --out capture/
"""


@options
class Options(Samples, Ranges, PointChoice, Written):
    """Takes raw ADC samples of a real radar through range, Doppler, angle and CFAR."""

    GROUPS: ClassVar[dict[str, str]] = {"points": "output"}

    file: Path | None = option(
        "adc_data.bin of a DCA1000 or its parts X_Raw_0.bin, its packets as .pcap or .pcapng, raw ADC samples as .npy,"
        " .mat or HDF5, radar.npz, a HuPR, mmMesh, RF-Genesis or CubeLearn array, or a folder that brings its radar: of"
        " a DCA1000 capture with its .cfg or mmWave Studio files, of mmwave-capture-std (radar.cfg, dca.pcap), of"
        " Infineon's Radar SDK (config.json, radar.npy)",
        "FILE|DIR",
        positional=True,
    )
    out: Path = option("folder for the results", "DIR", default=MISSING, is_setting=False)
    board: Source | None = option(
        "board.json of the board that recorded it (mmweaver calibrate), whose errors are removed", "FILE"
    )
    remove_static: Literal["auto", "mean_chirp", "mean_frame"] | None = option(
        "remove static clutter from the cube and its points: the mean over each frame's chirps, or over all frames"
        " (auto: over frames where a frame has fewer than four loops)"
    )
    strict: bool = option(
        "refuse a recording that has lost samples, or that does not agree with its radar, instead of warning",
        default=False,
    )
    no_analysis: bool = option("do not look for slow movement, breathing, micro-Doppler and people", default=False)
    no_pictures: bool = option("leave out all pictures", default=False)


def run(asked: Options) -> int:
    """Processes the recording and writes the results.

    A long recording is processed in blocks in the folder .OUT.process, which stays if the run is interrupted: the same
    command then continues.

    Raises:
        InputError: For a recording or options that cannot be used.
    """
    from mmweaver.cli.progress import StageBar
    from mmweaver.cli.summary import machine_summary, summary_lines
    from mmweaver.core.output_checks import check_output_folder

    if asked.file is None:
        raise InputError("which recording? give a file or a capture folder (see mmweaver process --help)")
    from mmweaver.io.result_folder import FILES

    check_output_folder(asked.out, overwrite=asked.overwrite, files=FILES, inputs=[asked.file])
    work = asked.out.absolute().with_name(f".{asked.out.absolute().name}.process")
    with StageBar(NUM_STAGES, quiet=asked.quiet or asked.verbose, patience_s=0.5) as bar:
        from mmweaver.core.stages import Stages
        from mmweaver.recordings.processing import process_recording

        recording = process_recording(
            asked.file,
            asked.radar_name(),
            range_m=asked.range_m,
            range_bins=asked.range_bins,
            points=asked.points,
            static_removal=asked.remove_static or "none",
            board=asked.board,
            analyse=not asked.no_analysis,
            strict=asked.strict,
            stages=Stages(bar),
            work=work,
            progress=partial(bar.progress, "frames"),
            **asked.reading(),
        )
        written = {REQUEST_FILE: request_toml(asked)}
        meta = recording.save(asked.out, overwrite=asked.overwrite, extra=written, pictures=not asked.no_pictures)
    shutil.rmtree(work, ignore_errors=True)
    return asked.report(machine_summary(asked.out, meta), *summary_lines(asked.out, meta, verbose=asked.verbose))
