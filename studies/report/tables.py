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
from studies.report.paper_items import paper_table
from studies.report.table_layouts import MatrixTable, MetricTable, PivotTable, RowTable

FIDELITY_SCORES = ("nmse_db", "nmse_active_db", "nmse_moving_db", "psnr_db", "cssim", "rd_ssim", "ra_ssim", "chamfer_m")
FIDELITY = RowTable(
    sources=tuple(
        f"field_fidelity/{name}" for name in ("inr_paper", "inr_smooth_short", "inr_modulated", "scatterers")
    ),
    before=(("*zeros*", "baseline.zeros"), ("*static_mean*", "baseline.static_mean"),
            ("*other realization*", "oracle.realization"), ("*noise_free*", "oracle.noise_free")),
    columns=(("signal", "{dataset.name}"), ("method", "{label}"), ("values", "{size.values:,}"),
             ("fit CPU s", "{seconds.fit:.0f}"), *((name, f"{{metrics.{name}:number}}") for name in FIDELITY_SCORES)),
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

BOTH = (("ra_ssim", "RA"), ("rd_ssim", "RD"))
SCORES = RowTable(
    sources=("learned_scores/test_room",),
    labels={
        "zeros": "all zeros (baseline)",
        "training_mean": "mean of the training rooms (baseline)",
        "nearest_training_pose": "the nearest training pose's recording (baseline)",
        "generic_room_physics": "physics in some other room (baseline)",
        "wrong_photo": "the network, another room's photo (baseline)",
        "weaver": "**the network**",
        "physics_in_photographed_room": "physics in the photographed room",
        "realization": "physics in the true room, other phases (oracle)",
        "static_mean": "the ground truth's own static mean (needs a recording of it)",
        "weaver_with_background": "**the network with a background recording**",
        "realization_skin": "physics in the true room, its phases known (oracle of that)",
    },
    columns=(
        ("made by", "{label}"),
        ("RA SSIM", "{metrics.ra_ssim:interval.2}"), ("RD SSIM", "{metrics.rd_ssim:interval.2}"),
        ("RA, all cells", "{metrics.ra_ssim_all_cells:fixed.2}"),
        ("RD, all cells", "{metrics.rd_ssim_all_cells:fixed.2}"),
        ("RD difference, dB", "{metrics.rd_difference_db:fixed.2}"),
        ("NMSE of magnitude, dB", "{metrics.magnitude_nmse_db:fixed.2}"),
        ("antenna phase error, rad", "{metrics.antenna_phase_error_rad:fixed.2}"),
        ("Chamfer, m", "{metrics.chamfer_m:fixed.2}"), ("Hausdorff, m", "{metrics.hausdorff_m:fixed.2}"),
        ("energy, dB", "{metrics.energy_db:fixed.1}"), ("CPU, s", "{metrics.cpu_s:fixed.2}"),
    ),
)  # fmt: skip
POWER = RowTable(
    sources=("learned_scores/paper_power",),
    labels={
        "zeros": "all zeros (baseline)",
        "generic_room_physics": "physics in some other room (baseline)",
        "paper_power": "`paper_power`",
        "paper_power_wrong_photo": "`paper_power`, shown another room's photo",
        "paper_power_untrained": "`paper_power` before training: its coordinates alone",
        "weaver": "`weaver`",
        "physics_in_photographed_room": "physics, from the photo",
        "realization": "the true room, random phases (oracle)",
    },
    columns=(("made by", "{label}"), ("rooms", "{n}"), *SCORES.columns[1:]),
)
SUMMARY = RowTable(
    sources=("peer_scores/test_room", "learned_scores/test_room"),
    labels={
        "zeros": "all zeros (baseline)",
        "generic_room_physics": "physics in some other room (baseline)",
        "rf_genesis_as_released": "RF-Genesis as released",
        "rf_genesis_repaired_photographed_room": "RF-Genesis repaired, in the photographed room",
        "weaver": "the network, from the photo",
        "physics_in_photographed_room": "physics, from the photo",
        "realization": "the true room, random phases (oracle for a photo)",
        "weaver_with_background": "the network, with a background recording",
        "realization_skin": "the true room, its phases known (oracle for a recording)",
    },
    columns=(
        ("made by", "{label}"), ("range-azimuth, SSIM", "{metrics.ra_ssim:interval.2}"),
        ("range-Doppler, SSIM", "{metrics.rd_ssim:interval.2}"),
    ),
)  # fmt: skip
PEERS = RowTable(
    sources=("peer_scores/test_room",),
    labels={
        "zeros": "all zeros (baseline)",
        "generic_room_physics": "our physics in some other room (baseline)",
        "rf_genesis_as_released": "RF-Genesis, as released",
        "rf_genesis_repaired_body": "RF-Genesis, repaired, body alone",
        "rf_genesis_repaired_generic_room": "RF-Genesis, repaired, some other room",
        "rf_genesis_repaired_photographed_room": "RF-Genesis, repaired, our photographed room",
        "weaver": "our network, from the photo",
        "physics_in_photographed_room": "our physics, from the photo",
        "realization": "the true room, random phases (oracle)",
    },
    columns=(
        ("made by", "{label}"), ("rooms", "{n}"), ("range-azimuth, SSIM", "{metrics.ra_ssim:interval.2}"),
        ("range-Doppler, SSIM", "{metrics.rd_ssim:interval.2}"), ("cSSIM", "{metrics.cssim:fixed.3}"),
        ("PSNR, dB", "{metrics.psnr_db:fixed.1}"), ("Chamfer, m", "{metrics.chamfer_m:fixed.2}"),
        ("CPU, s", "{metrics.cpu_s:fixed.1}"),
    ),
)  # fmt: skip
UNSEEN_METHODS = (
    "nearest_training_pose", "weaver", "weaver_with_background", "physics_in_photographed_room", "realization",
)  # fmt: skip
UNSEEN = PivotTable(
    sources=tuple(f"learned_scores/test_{split}" for split in ("room", "layout", "person", "activity")),
    labels={"test_room": "kind of room", "test_layout": "layout of a seen kind", "test_person": "person",
            "test_activity": "activity"},
    rows=(("unseen", "{label}"), ("sequences", "{n}")), across="{method}",
    cells={name: tuple((f"{name}, {view}", f"{{metrics.{metric}:{'interval' if name == 'weaver' else 'fixed'}.2}}")
                       for metric, view in BOTH) for name in UNSEEN_METHODS},
)  # fmt: skip
OTHER_RADARS = PivotTable(
    sources=tuple(f"other_radars/{name}" for name in ("hupr", "mmmesh", "iwr6843", "iwr1443_mars",
                                                      "awr1843_100_frames")),
    labels={"hupr": "preset `hupr`", "mmmesh": "`mmmesh`", "iwr6843": "`iwr6843`", "iwr1443_mars": "`iwr1443_mars`",
            "awr1843_100_frames": "`awr1843`, 100 frames"},
    rows=(("seen by", "{label}"), ("rooms", "{num_rooms}")), across="{method}",
    cells={name: ((f"{name}, RA / RD", "{metrics.ra_ssim:fixed.2} / {metrics.rd_ssim:fixed.2}"),)
           for name in ("zeros", "generic_room_physics", "weaver", "physics_in_photographed_room", "realization")},
)  # fmt: skip
PAPER_COLUMNS = (
    ("cSSIM", "{metrics.cssim:fixed.3}"), ("PSNR, dB", "{metrics.psnr_db:fixed.1}"),
    ("NMSE, all cells, dB", "{metrics.nmse_db:fixed.2}"), ("active, dB", "{metrics.nmse_active_db:fixed.2}"),
    ("moving, dB", "{metrics.nmse_moving_db:fixed.2}"), ("RD SSIM", "{metrics.rd_ssim:fixed.2}"),
    ("RA SSIM", "{metrics.ra_ssim:fixed.2}"),
)  # fmt: skip
PAPER = RowTable(sources=("paper_scores/test_room",), columns=(("method", "{method}"), *PAPER_COLUMNS))
PAPER_FEW = RowTable(
    sources=("paper_scores/few_train", "paper_scores/few_test_room"),
    columns=(("method", "{method}"), ("evaluated on", "{dataset.split:split}"), *PAPER_COLUMNS),
)


def _gain(source: str) -> RowTable:
    """Accuracy of the recogniser in an unseen room with the data of each method, and the gain over none."""
    return RowTable(
        sources=(source,),
        columns=(
            ("generated data of the room by", "{method}"), ("accuracy", "{metrics.accuracy:percent_interval.1}"),
            ("gain, points", "{metrics.gain:points_interval.1}"),
            ("log loss less by", "{metrics.log_loss_gain:signed_interval.3}"),
        ),
    )  # fmt: skip


COST = MatrixTable(
    sources=("benchmark/weaver",), corner="what", prefixes=(("measured", ""),),
    lines=(
        ("weaver_motion_to_cube_cpu_s", "network, motion to cube of 20 frames, room encoded, CPU", "{metric:.3f} s"),
        ("physics_motion_to_cube_cpu_s", "physics (paths of second order), the same, room prepared, CPU",
         "{metric:.3f} s"),
        ("times_fewer_cpu_s_than_physics", "ratio of the two", "{metric:.1f}"),
        ("first_order_motion_to_cube_cpu_s", "physics of first order, CPU", "{metric:.3f} s"),
        ("sentence_to_motion_cpu_s", "sentence to motion, for either, CPU", "{metric:.3f} s"),
        ("sentence_to_cube_wall_s", "network, sentence to cube, wall", "{metric:.2f} s"),
        ("weaver_encode_room_cpu_s", "encoding the reconstructed room, once, CPU", "{metric:.2f} s"),
        ("weaver_peak_memory_gb", "network, peak memory of the process", "{metric:.2f} GB"),
    ),
)  # fmt: skip

TABLES: dict[str, Callable[[Path], str]] = {
    "paper": paper_table, "sampling_radius": SAMPLING_RADIUS.render,
    "field_fidelity": FIDELITY.render, "super_resolution": SUPER_RESOLUTION.render,
    "codecs": codecs_table, "codec_margins": codec_margins_table, "codec_cuts": codec_cuts_table,
    "codec_seconds": CODEC_SECONDS.render,
    "physics": PHYSICS.render, "dataset_cost": DATASET_COST.render,
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
    "peer_scores": PEERS.render,
    "learned_scores": SCORES.render, "learned_summary": SUMMARY.render, "learned_unseen": UNSEEN.render,
    "other_radars": OTHER_RADARS.render,
    "paper_scores": PAPER.render, "paper_scores_few": PAPER_FEW.render,
    "activity_gain": _gain("activity_gain/test_room").render,
    "activity_gain_60": _gain("activity_gain/recordings_60").render,
    "learned_cost": COST.render, "power_scores": POWER.render,
}  # fmt: skip
