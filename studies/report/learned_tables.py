"""Declared tables of the learned method: unseen rooms, other radars, tuning, recognition, the paper's network."""

from studies.report.table_layouts import MatrixTable, PivotTable, RowTable

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
LEARNED = {
    "peer_scores": PEERS,
    "learned_scores": SCORES, "learned_summary": SUMMARY, "learned_unseen": UNSEEN,
    "other_radars": OTHER_RADARS,
    "paper_scores": PAPER, "paper_scores_few": PAPER_FEW,
    "activity_gain": _gain("activity_gain/test_room"), "activity_gain_60": _gain("activity_gain/recordings_60"),
    "learned_cost": COST, "power_scores": POWER,
}  # fmt: skip
