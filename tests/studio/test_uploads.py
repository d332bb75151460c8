"""What visitors bring is known by what it is, kept inside the session's folder, and refused in one line."""

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from mmweaver.core.boards import PRESETS, find_board
from mmweaver.core.errors import InputError
from mmweaver.studio.sessions import Session, Sessions
from mmweaver.studio.uploads import file_names, place_of, take
from tests import captures
from tests.fuzz.corpus import corpus
from tests.io.point_clouds.test_read_points import XYZV, out_of_box
from tests.scene.test_scan_folders import polycam, tum

AWR = PRESETS["awr1843"]
SAMPLE = Path(__file__).resolve().parents[2] / "src" / "mmweaver" / "sample"


@pytest.fixture
def session() -> Iterator[Session]:
    every = Sessions()
    yield every.open()
    every.end_all()


def test_the_log_of_a_data_port_is_watched(session: Session, tmp_path: Path):
    (tmp_path / "log.dat").write_bytes(b"".join(out_of_box(number, XYZV) for number in range(5)))
    found = take(session, tmp_path, AWR)
    shown = session.result(found["id"]).playback()
    assert found["kind"] == "result"
    assert shown.header["frames"] == 5
    assert shown.header["frame_period_s"] == pytest.approx(0.1)
    assert len(shown.arrays["points"]) == 15
    assert shown.arrays["range_doppler"].max() == 255
    assert "no .cfg" in shown.header["meta"]["assumed"][0]


def test_the_cfg_next_to_a_log_says_how_often(session: Session, tmp_path: Path):
    (tmp_path / "log.dat").write_bytes(out_of_box(1, XYZV) + out_of_box(2, XYZV))
    (tmp_path / "board.cfg").write_text(captures.CFG.replace(" 100 1 0", " 50 1 0"))
    found = session.result(take(session, tmp_path, AWR)["id"])
    assert found.frame_period_s == pytest.approx(0.05)


@pytest.mark.parametrize("write", [polycam, tum])
def test_the_folder_of_a_scan_becomes_a_room(write: Callable[[Path], None], session: Session, tmp_path: Path):
    write(tmp_path / "dropped" / "scan")
    found = take(session, tmp_path / "dropped", AWR)
    assert found["kind"] == "room"
    assert session.rooms[found["id"]].room.scene.free_space.is_free.any()


def test_paths_are_kept_within_the_folder(tmp_path: Path):
    for said in ("scan/depth/000000.png", "../../etc/passwd", "/abs/../x", "..", "a/b/c/d/e/f/g.png", "C:\\x\\..\\y"):
        place = place_of(tmp_path, said)
        place.write_bytes(b"x")
        assert tmp_path in place.resolve().parents
    assert (tmp_path / "scan" / "depth" / "000000.png").is_file()
    assert place_of(tmp_path, "scan/depth/000000.png").name != "000000.png"  # nothing is overwritten


@pytest.mark.parametrize("listed", ["[1, 2]", '["a"]', "{}", '"a"', None])
def test_paths_that_do_not_fit_are_left_out(listed: str | None):
    assert file_names(listed, ["a.png", None]) == ["a.png", "file"]
    assert file_names(json.dumps(["x/a.png", "b"]), ["a.png", None]) == ["x/a.png", "b"]


def test_a_radar_alone_is_a_radar(session: Session, tmp_path: Path):
    (tmp_path / "mine.json").write_text(replace(AWR, num_loops=16).to_json())
    found = take(session, tmp_path, AWR)
    assert session.radars[found["id"]][1].num_loops == 16


def test_a_board_alone_is_a_board(session: Session, tmp_path: Path):
    find_board("typical:3", AWR).save(tmp_path / "mine.json")
    found = take(session, tmp_path, AWR)
    assert found["kind"] == "board"
    assert session.boards[found["id"]][1].digest == find_board("typical:3", AWR).digest


def test_the_fuzz_corpus_leaves_one_line(session: Session, tmp_path: Path):
    """Everything that once ended a reader in a traceback, dropped under the name that its reader knows it by."""
    names = {
        "radar.json": "radar.json", "TI cfg": "a.cfg", "radar.npz": "radar.npz", "motion npz": "motion.npz",
        "motion npy": "motion.npy", "depth npy": "depth.npy", "samples npy": "a.npy", "pose.npz": "pose.npz",
    }  # fmt: skip
    for number, (reader, what, content) in enumerate(corpus()):
        name = names.get(reader, "a" + {"bvh": ".bvh", "png": ".png", "jpg": ".jpg"}.get(reader, ".dat"))
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / name).write_bytes(content)
        if name == "depth.npy":
            (folder / "rgb.webp").write_bytes((SAMPLE / "rgb.webp").read_bytes())
        with pytest.raises(InputError) as refused:
            take(session, folder, AWR)
        assert "\n" not in str(refused.value), f"{reader}, {what}"
