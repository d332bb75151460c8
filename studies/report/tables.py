"""Every table of the documentation, declared: which results, which rows, which columns.

`python -m studies tables` fills them in; `table_layouts` says what the fields mean, `cell_formats` the templates.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from studies.report.computed_tables import (
    ablation_table,
    activities_table,
    codec_cuts_table,
    codec_margins_table,
    codecs_table,
    statistics_table,
)
from studies.report.learned_tables import LEARNED
from studies.report.paper_items import paper_table
from studies.report.table_layouts import MatrixTable, MetricTable, PivotTable, RowTable

SCORES = ("nmse_db", "nmse_active_db", "nmse_moving_db", "psnr_db", "cssim", "rd_ssim", "ra_ssim", "chamfer_m")
FIDELITY = RowTable(
    sources=tuple(f"field_fidelity/{name}" for name in ("inr_paper", "inr_smooth_short", "scatterers")),
    before=(("*zeros*", "baseline.zeros"), ("*static_mean*", "baseline.static_mean"),
            ("*other realization*", "oracle.realization"), ("*noise_free*", "oracle.noise_free")),
    columns=(("signal", "{dataset.name}"), ("method", "{label}"), ("values", "{size.values:,}"),
             ("fit CPU s", "{seconds.fit:.0f}"), *((name, f"{{metrics.{name}:number}}") for name in SCORES)),
    missing="",
)  # fmt: skip
FINER = ("1.5", "2", "3", "4")
SUPER_RESOLUTION = PivotTable(
    sources=("super_resolution/*",),
    rows=(("ground truth", "{dataset.truth}"), ("times finer, or radius", "{dataset.factor:g}")),
    across="{record.method}", cell_template="{metrics.nmse_db:number}",
    order=(("own_cells", "1"), *(("between_bins", factor) for factor in FINER),
           *(("sampled_places", str(radius)) for radius in range(1, 8)),
           *((kind, factor) for kind in ("more_bandwidth", "more_loops", "more_antennas") for factor in FINER)),
)  # fmt: skip
RADIUS_COLUMNS = {
    "zero_padding": "zero padding (baseline)", "linear_raw": "linear", "linear_centred": "linear, phases centred",
    "inr_paper": "the paper's INR", "inr_smooth_short": "our INR", "scatterers": "scatterers",
}  # fmt: skip
SAMPLING_RADIUS = PivotTable(
    sources=("super_resolution/*",),
    rows=(("ground truth", "{dataset.truth}"), ("radius, eighths of a bin", "{dataset.factor:g}")),
    across="{record.method}",
    cells={name: ((head, "{metrics.nmse_db:number}"),) for name, head in RADIUS_COLUMNS.items()},
    order=tuple(("sampled_places", str(radius)) for radius in range(1, 8)),
)
CODEC_SECONDS = PivotTable(
    sources=("codecs/mmw",), rows=(("signal", "{dataset.name}"),), across="{size.bytes_allowed}", sorts=True,
    head_template="{size.bytes_allowed:,} B", cell_template="{seconds.encode_cpu:.1f}",
)  # fmt: skip
PHYSICS = MatrixTable(
    sources=("benchmark/physics",), corner="what", prefixes=(("measured", ""),),
    lines=(
        ("command_wall_s", "`mmweaver generate --demo`, imports and pictures included, wall", "{metric:.1f} s"),
        ("command_peak_memory_gb", "its peak memory", "{metric:.2f} GB"),
        ("physics_command_wall_s", "the same with `--method physics`", "{metric:.1f} s"),
        ("physics_command_peak_memory_gb", "its peak memory", "{metric:.2f} GB"),
        ("sequence_cpu_s",
         "by physics, 20 frames of a person of 800 points in the furnished sample room, room loaded, CPU",
         "{metric:.2f} s"),
        ("room_cpu_s", "loading the room, CPU", "{metric:.2f} s"),
        ("times_cheaper_than_exact", "the exact sum of the same echoes costs (extrapolated from one frame)",
         "{metric:.0f} times that"),
        ("synthesis_error_at_rest_db", "error of the range-Doppler cube against the exact sum, static",
         "{metric:.1f} dB"),
        ("synthesis_error_at_0.5_mps_db", "up to 0.5 m/s and 5 m/s2 on each axis", "{metric:.1f} dB"),
        ("synthesis_error_at_3_mps_db", "up to 3 m/s and 30 m/s2 on each axis", "{metric:.1f} dB"),
    ),
)  # fmt: skip
DATASET_COST = MatrixTable(
    sources=("benchmark/dataset",), corner="what", missing="",
    prefixes=(("with signals", "signals_"), ("geometry only", "geometry_only_")),
    lines=(
        ("cpu_s_a_sequence", "a sequence of 20 frames, CPU", "{metric:.2f} s"),
        ("cpu_s_a_room", "a room with its photo, CPU", "{metric:.1f} s"),
        ("kb_a_sequence", "a sequence on disk", "{metric:.0f} kB"),
        ("kb_a_room", "a room on disk", "{metric:.0f} kB"),
        ("10_million_core_days", "10 million sequences, 120 a room", "{metric:.0f} core-days"),
        ("10_million_tb", "the same on disk", "{metric:.1f} TB"),
        ("sequences_a_s_1_workers", "sequences a second, 1 worker", "{metric:.1f}"),
        ("sequences_a_s_2_workers", "2 workers", "{metric:.1f}"),
        ("sequences_a_s_4_workers", "4 workers", "{metric:.1f}"),
    ),
)  # fmt: skip
CHECKSUMS_COST = MatrixTable(
    sources=("benchmark/checksums",), corner="reading an epoch, CPU", missing="",
    prefixes=(("with signals", "signals_"), ("geometry only", "geometry_only_")),
    lines=(
        ("first_epoch_cpu_s", "the first of a process: every file is hashed", "{metric:.2f} s"),
        ("later_epoch_cpu_s", "each later one", "{metric:.2f} s"),
        ("unchecked_epoch_cpu_s", "without checks (baseline)", "{metric:.2f} s"),
        ("mb", "size of the data set", "{metric:.0f} MB"),
    ),
)  # fmt: skip
REAL_ROOMS = RowTable(
    sources=("real_rooms/physics",),
    columns=(
        ("room", "{dataset.name}"), ("frames", "{n}"),
        ("person in place", "{metrics.frames_with_person_in_place:percent.0}"),
        ("a random bin", "{metrics.frames_with_person_in_place.baseline.random_bin:percent.0}"),
    ),
)  # fmt: skip
AFFORDANCES = MatrixTable(
    sources=("affordances/*",), corner="what", head="{dataset.name}, {record.method} ({n})",
    lines=(
        ("floor_error_median_m", "floor height, median error", "{metric:.3f} m"),
        ("floor_error_p95_m", "95th percentile", "{metric:.3f} m"),
        ("floor_within_3_cm", "within 3 cm", "{metric:share.1}"),
        ("seats_found", "seats found", "{metric:share.1}"),
        ("false_seats", "found seats that are none", "{metric:share.1}"),
        ("facing_error_median_deg", "facing, median error", "{metric:.0f} deg"),
        ("table_found", "tables and counters found", "{metric:share.1}"),
        ("table_false", "found ones that are none", "{metric:share.1}"),
        ("door_found", "doors found", "{metric:share.1}"),
        ("door_false", "found ones that are none", "{metric:share.1}"),
        ("window_found", "windows found", "{metric:share.1}"),
        ("window_false", "found ones that are none", "{metric:share.1}"),
        ("bed_found", "beds found", "{metric:share.1}"),
        ("bed_false", "found ones that are none", "{metric:share.1}"),
        ("placements_clear", "placements clear of furniture", "{metric:share_interval.1}"),
        ("arms_clear", "arms too", "{metric:share.1}"),
    ),
)  # fmt: skip
MARS_COLUMNS = (
    ("chamfer_m", "Chamfer, m", "interval.3"), ("hausdorff_m", "Hausdorff, m", "fixed.2"),
    ("centroid_m", "centroid, m", "fixed.2"), ("extent_m", "extent, m", "fixed.3"), ("points", "points", "fixed.1"),
    ("points_error", "points off by", "fixed.1"), ("points_correlation", "points corr.", "fixed.2"),
    ("empty", "empty", "fixed.2"), ("doppler", "Doppler TV", "fixed.3"),
    ("speed_correlation", "speed corr.", "fixed.2"), ("intensity_db", "intensity, dB", "fixed.1"),
)  # fmt: skip
MARS_ROWS = (
    "baseline_centroid", "baseline_random_on_body", "baseline_random_real_frame", "oracle_neighbouring_frame",
    "oracle_same_pose_again", "simulator",
)  # fmt: skip
MARS = RowTable(
    sources=("mars/*",), key="record.method", labels={name: name.replace("_", " ") for name in MARS_ROWS},
    columns=(("", "{label}"), *((head, f"{{metrics.{name}:{form}}}") for name, head, form in MARS_COLUMNS)),
)  # fmt: skip
MARS_VALIDATE = replace(MARS, sources=("mars_validate/*",))
KITML = MetricTable(
    sources=("kitml/reading",),
    columns=(("share", "{label}"), ("n", "{metric.n:,}"), ("value", "{metric:percent.1}"),
             ("95 % interval", "{metric:edges_percent.1}")),
    lines=(
        ("understood", "understood, of all"),
        ("understood_checking_half", "understood, of the half not developed on"),
        ("understood_draw", "understood, of 300 drawn uniformly from that half"),
        ("understood_development_draw", "understood, of 1,100 of that half read to widen the grammar"),
        ("understood_frozen", "understood, of 300 in no earlier sample (harder than the half; frozen grammar)"),
        ("understood_fresh_draw", "the same, by today's grammar, which what was wrong there has changed"),
        ("understood_new_sentences",
         "understood, of those among them whose words occur in no sentence of the other half"),
        ("wrong_first_sample", "wrong by hand, first sample (faults mended since)"),
        ("wrong_second_sample", "wrong by hand, second sample (faults mended since)"),
        ("wrong_third_sample", "wrong by hand, third sample (faults mended since)"),
        ("wrong_fourth_sample", "wrong by hand, fourth sample (grammar before the freeze)"),
        ("wrong_fifth_sample", "wrong by hand, fifth sample (grammar before the development draw)"),
        ("wrong_sixth_sample", "wrong by hand, sixth sample (faults mended since)"),
        ("wrong_seventh_sample", "wrong by hand, seventh sample (faults mended since)"),
        ("wrong", "wrong by hand without a word, understood ones of the last 300 (frozen grammar; mended since)"),
        ("said", "shown otherwise or in part, which is said, of the same"),
        ("wrong_seen_since", "wrong by today's grammar, of the same 300, all read since (not blind)"),
    ),
)  # fmt: skip
UNDERSTOOD_SINCE = (("understood_today", "understood by the grammar that the faults found have changed"),)
RECORDED_DONE = (("recorded_done", "recorded as done though shown otherwise, said or not, of the same"),)
CAPTIONS = ("fifth", "sixth", "seventh", "eighth", "ninth")  # the newest draws of people's captions
UNREAD = {
    f"unread_{'captions' if 'captions' in name else 'prompts'}{name.removeprefix('_captions')}": MetricTable(
        sources=(f"unread_prompts/reading{name}",),
        columns=KITML.columns,
        lines=(
            ("understood", "understood, of all (frozen grammar)"),
            ("wrong", f"wrong by hand without a word, of the understood{' (mended since)' if is_mended else ''}"),
            ("said", "shown otherwise or in part, which is said, of the same"),
            *(RECORDED_DONE if name == "_captions_ninth" else ()),
            *(UNDERSTOOD_SINCE if is_mended else ()),
            *((("in_part_today", "of these, a clause is not done, which is said"),) if in_part else ()),
        ),
    )
    for name, in_part, is_mended in (
        ("", False, True), ("_second", False, True), ("_captions", False, True), ("_third", True, True),
        ("_captions_second", True, True), ("_captions_third", True, True), ("_captions_fourth", True, True),
        ("_strangers", True, True), ("_strangers_second", True, True), ("_strangers_third", True, False),
        ("_strangers_fourth", True, False), *((f"_captions_{draw}", True, False) for draw in CAPTIONS),
    )
}  # fmt: skip
CAPTIONS_DRAWS = RowTable(
    sources=tuple(f"unread_prompts/reading_captions_{draw}" for draw in CAPTIONS),
    columns=(
        ("draw", "{label}"), ("captions", "{n}"), ("understood", "{metrics.understood:percent_interval.1}"),
        ("of these wrong without a word", "{metrics.wrong:percent_interval.1}"),
        ("of these shown otherwise, which is said", "{metrics.said:percent_interval.1}"),
        ("of these recorded as done though shown otherwise", "{metrics.recorded_done:percent_interval.1}"),
    ),
    labels={f"prompts of other projects, captions_{draw} draw": draw for draw in CAPTIONS},
    key="dataset.name",
)  # fmt: skip
STRANGERS = MetricTable(
    sources=("strangers/default",),
    columns=(("200 sentences", "{label}"), ("share", "{metric:percent.1}")),
    lines=(
        ("made_before", "made at the default command before (version 0.2.0)"),
        ("made", "made now"),
        ("done", "of all: every clause as it was said"),
        ("approximated", "of all: a clause approximated or not shown, and said so"),
    ),
)  # fmt: skip
BLIND = RowTable(
    sources=("blind_recognition/*",),
    columns=(
        ("task", "{dataset.name}"), ("role", "{role}"), ("recordings", "{how}"),
        ("people generated", "{record.config.options.sequences}"), ("windows", "{metrics.window:interval.2}"),
        ("three windows", "{metrics.three_windows:interval.2}"), ("a recording", "{metrics.recording:interval.2}"),
        ("chance", "{metrics.window.baseline.chance:.2f}"), ("generated people", "{metrics.generated:.2f}"),
        ("windows outside", "{distance.windows_outside:.2f}"),
    ),
)  # fmt: skip
CURVE_CELL = "{metrics.window:.3f} ({metrics.window.lowest:.3f} to {metrics.window.highest:.3f})"
LABELLED = PivotTable(
    sources=("labelled_recognition/*",),
    rows=(("task", "{dataset.name}"), ("recordings of each", "{real_recordings_each}")), across="{generated}",
    cells={"False": (("without", CURVE_CELL),),
           "True": (("with generated windows", CURVE_CELL), ("difference", "{metrics.gain:signed_interval.3}"))},
    missing="",
)  # fmt: skip
LABELLED_RADHAR = replace(
    LABELLED, sources=("labelled_recognition/radhar",), rows=(("real recordings of each", "{real_recordings_each}"),)
)

ZERO_SHOT_POSE = RowTable(
    sources=("zero_shot_pose/mars_*",),
    columns=(
        ("split", "{dataset.split}"), ("poses by", "{method}"), ("root", "{metrics.root_all:.1f}"),
        ("centroid", "{metrics.centroid_all:.1f}"), ("Procrustes", "{metrics.procrustes_all:.1f}"),
        *((f"{group}, centroid", f"{{metrics.centroid_{group}:.1f}}") for group in ("torso", "head", "arms", "legs")),
    ),
)  # fmt: skip
POSE_CURVE = RowTable(
    sources=("zero_shot_pose/curve_*",),
    columns=(
        ("minutes of the person", "{minutes}"), ("generated people first, centroid", "{metrics.centroid_all:.1f}"),
        ("without", "{metrics.centroid_all.baseline.without_generated:.1f}"),
        ("generated first, legs", "{metrics.centroid_legs:.1f}"),
        ("without, legs", "{metrics.centroid_legs.baseline.without_generated:.1f}"),
    ),
)  # fmt: skip

TABLES: dict[str, Callable[[Path], str]] = {
    "paper": paper_table, "sampling_radius": SAMPLING_RADIUS.render,
    "field_fidelity": FIDELITY.render, "super_resolution": SUPER_RESOLUTION.render,
    "codecs": codecs_table, "codec_margins": codec_margins_table, "codec_cuts": codec_cuts_table,
    "codec_seconds": CODEC_SECONDS.render,
    "physics": PHYSICS.render, "dataset_cost": DATASET_COST.render,
    "checksums_cost": CHECKSUMS_COST.render,
    "real_rooms": REAL_ROOMS.render, "affordances": AFFORDANCES.render,
    "signal_statistics": statistics_table, "mars": MARS.render,
    "mars_validate": MARS_VALIDATE.render,
    "kitml": KITML.render, "strangers": STRANGERS.render,
    **{name: table.render for name, table in UNREAD.items()},
    "activities": activities_table, "captions_draws": CAPTIONS_DRAWS.render,
    "blind_recognition": BLIND.render,
    "zero_shot_pose": ZERO_SHOT_POSE.render,
    "pose_curve": POSE_CURVE.render,
    "labelled_recognition": LABELLED.render, "labelled_radhar": LABELLED_RADHAR.render,
    "ablation": ablation_table, "ablation_power": partial(ablation_table, folder="ablation_power"),
    **{name: table.render for name, table in LEARNED.items()},
}  # fmt: skip
