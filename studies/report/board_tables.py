"""Declared tables of boards: calibrated, typical, and whether signals can be distinguished from recorded ones."""

from studies.report.table_layouts import MetricTable, RowTable

BOARD_MATCH = RowTable(
    sources=("board_match/openradar_two_people", "board_match/iwr6843_dca1000", "board_match/bgt60_breathing"),
    columns=(
        ("recording", "{dataset.name}"), ("feature", "{title}"),
        ("recorded", "{metrics.feature.oracle.recorded:number}"),
        ("ideal board (baseline)", "{metrics.feature.baseline.ideal:number}"),
        ("typical boards (baseline)", "{metrics.feature.baseline.typical:number}"),
        ("calibrated board", "{metrics.feature:number}"),
    ),
)  # fmt: skip
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
HALO_ROWS = (
    ("behind_body_near", "0.6 to 1 m behind a body, dB"), ("behind_body_far", "1 to 2 m behind, dB"),
    ("clutter_peak_over_median", "clutter's peak over its median, dB"), ("plane_wave_share", "best plane wave"),
    ("antenna_spread", "spread over antennas, dB"),
)  # fmt: skip
ROOMS_WITHIN = MetricTable(
    sources=("board_left_out/physics_rooms", "rooms_without_facing_wall/physics_rooms"),
    columns=(
        ("row", "{label}"), ("physics", "{method}"), ("median of rooms", "{metric:number}"),
        ("rooms within what was recorded", "{metric.within} of {metric.of}"),
        ("perfect simulator, range of 2 / 3 recordings",
         "{metric.oracle.of_2_recordings:.1f} / {metric.oracle.of_3_recordings:.1f} of {metric.of}"),
    ),
    lines=HALO_ROWS,
)  # fmt: skip
BOARDS = {
    "board_match": BOARD_MATCH, "echo_gain": ECHO_GAIN, "board_left_out": BOARD_LEFT_OUT, "rooms_within": ROOMS_WITHIN,
}  # fmt: skip
