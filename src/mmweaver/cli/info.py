"""mmweaver info: what a .mmw file holds."""

from pathlib import Path
from typing import Any

from mmweaver.cli.option_groups import Printed
from mmweaver.core.options import MISSING, option, options

FLOAT32_STEP_DB = -110.0  # over the peak: the finest that levels can have, see `SegmentEncoder.finest_step`
EXAMPLES = """examples:
  mmweaver info walk.mmw
  mmweaver info walk.mmw --json
"""


@options
class Options(Printed):
    """Reads all of a .mmw file, checks it, and says what is in it."""

    file: Path = option("a .mmw or .mmwl file", "FILE", default=MISSING, positional=True)


def run(asked: Options) -> int:
    """Prints the description on stdout.

    Raises:
        InputError: If the file is damaged.
    """
    from mmweaver.compression.lossless_file import describe_lossless, is_lossless_file
    from mmweaver.compression.mmw_codec import describe_mmw

    is_raw = is_lossless_file(asked.file)
    facts = describe_lossless(asked.file) if is_raw else describe_mmw(asked.file)
    return asked.report(facts, *(_lines_of_samples(facts) if is_raw else _lines(facts)))


def _lines_of_samples(facts: dict[str, Any]) -> list[str]:
    kept = f"words within {facts['max_error_counts']} counts" if facts["max_error_counts"] else "every bit kept"
    return [
        f"{facts['file']}: {facts['bytes']:,} bytes, raw samples, {kept}",
        f"  radar    {facts['radar']['name']}",
        f"  frames   {facts['frames']} in {facts['blocks']} blocks",
        f"  ratio    {facts['ratio']:,} times fewer bytes than the recording",
        *_cut(facts),
    ]


def _cut(facts: dict[str, Any]) -> list[str]:
    cut = facts["cut_short_bytes"]
    return (
        [f"  cut      the file was cut short: its last {cut:,} bytes are no whole chunk and are left out"]
        if cut
        else []
    )


def _lines(facts: dict[str, Any]) -> list[str]:
    radar = facts["radar"]
    lines = [
        f"{facts['file']}: {facts['bytes']:,} bytes, every checksum right",
        f"  radar    {radar['name']}, {radar['num_antennas']} antennas, {radar['range_resolution_m'] * 100:.2f} cm and"
        f" {radar['velocity_resolution_mps']:.3f} m/s bins",
        f"  cube     {' x '.join(map(str, facts['shape']))} complex64 (frame, range, doppler, antenna), scale"
        f" {facts['scale'] if facts['scale'] is not None else 'unknown'}",
        f"  time     {facts['first_frame_s']:.3f} to {facts['last_frame_s']:.3f} s",
        f"  ratio    {facts['ratio']:,} times fewer bytes than complex64",
        *_cut(facts),
    ]
    for index, chunk in enumerate(facts["chunks"]):
        lines.append(
            f"  chunk {index}  {chunk['frames']} frames, {chunk['bytes']:,} bytes: {chunk['mode']};"
            f" {chunk['scatterers']} scatterers, {'a' if chunk['has_static'] else 'no'} static layer,"
            f" {chunk['residual_values']} residual values, {_steps(chunk['step_db'])},"
            f" noise {chunk['noise_db']:.1f} dB below the peak"
        )
    return lines


def _steps(step_db: float | None) -> str:
    if step_db is None:
        return "without loss"
    return f"steps {step_db:.1f} dB" + (", the last digits of float32" if step_db < FLOAT32_STEP_DB else "")
