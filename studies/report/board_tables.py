"""Declared tables of boards: calibrated, typical, and whether signals can be distinguished from recorded ones."""

from studies.report.table_layouts import RowTable

BOARD_LEFT_OUT = RowTable(
    sources=("board_left_out/physics",),
    labels={
        f"{condition}, {board} left out": f"{text}: {board}"
        for condition, text in (("before", "first order, ideal board"), ("after", "as generated"))
        for board in ("openradar_two_people", "iwr6843_hall", "bgt60_breathing")
    },
    columns=(("physics: board left out", "{label}"), ("units", "{n}"), ("accuracy", "{metrics.accuracy:interval.2}"),
        ("ranked right", "{metrics.ranking:number}"),
    ),
)  # fmt: skip
ECHO_GAIN = RowTable(
    sources=("echo_gain/physics",),
    columns=(
        ("recording", "{dataset.name}"),
        ("people over the noise of a cell, recorded, dB", "{metrics.echo_gain.recorded_over_noise_db:.1f}"),
        ("simulated, dB", "{metrics.echo_gain.simulated_over_noise_db:.1f}"),
        ("gain, dB", "{metrics.echo_gain:interval.1}"), ("simulated people", "{n}"),
    ),
)  # fmt: skip
BOARDS = {
    "echo_gain": ECHO_GAIN, "board_left_out": BOARD_LEFT_OUT,
}  # fmt: skip
