"""The front door: five lines, the files promised, the same bits for the same seed, no long work for a bad request."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import mmweaver
from mmweaver.core.board import Board
from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, PoseSequence, RadarCube, Scene
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.core.stages import Stages
from mmweaver.datasets.verification import verify
from mmweaver.io.npz_files import (
    read_npz,
    read_points_npz,
    read_poses_npz,
    read_radar_npz,
    write_radar_npz,
)
from mmweaver.io.stored_result import read_result
from mmweaver.models.methods import METHODS, Signal
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.signal.cube import radar_cube, remove_static
from mmweaver.signal.firmware import firmware_points
from mmweaver.signal.spectra import azimuth_axis_rad, range_azimuth_power
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Room

TEXT = "a person walks towards the radar"


@pytest.fixture(scope="module")
def weaver() -> Weaver:
    return Weaver("physics")


@pytest.fixture(scope="module")
def room(weaver: Weaver) -> Room:
    return weaver.sample_room()


@pytest.fixture(scope="module")
def walk(weaver: Weaver, room: Room, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of one short sequence."""
    out = tmp_path_factory.mktemp("walk") / "out"
    weaver.generate(room, TEXT, frames=4, seed=3, keep_adc=True).save(out, adc_data_bin=True)
    return out


def test_the_files_and_keys_promised(walk: Path):
    assert {file.name for file in walk.iterdir()} == {
        "radar.npz", "pose.npz", "points.npz", "adc_data.bin", "radar.json", "board.json", "meta.json", "preview.png",
        "preview.gif", "SHA256SUMS",
    }  # fmt: skip
    radar = read_npz(walk / "radar.npz")
    assert radar["cube"].shape == (4, 64, 32, 12)
    assert radar["cube"].dtype == np.complex64
    assert radar["frame_time_s"] == pytest.approx(np.arange(4) / 10)
    assert radar["range_m"].shape == (64,)
    assert radar["radial_velocity_mps"].shape == (32,)
    assert radar["antenna_position_m"].shape == (12, 3)
    pose = read_npz(walk / "pose.npz")
    assert pose["joints_m"].shape == (4, 22, 3)
    assert tuple(pose["joint_names"].tolist()) == JOINT_NAMES
    points = read_points_npz(walk / "points.npz")
    assert set(points.frame.tolist()) <= set(range(4))


def test_meta_says_how_to_make_it_again(walk: Path):
    meta = json.loads((walk / "meta.json").read_text())
    assert (meta["text"], meta["seed"], meta["frames"], meta["fps"]) == (TEXT, 3, 4, 10.0)
    assert (meta["method"], meta["version"]) == ("physics", mmweaver.__version__)
    assert mmweaver.RadarConfig.from_json(json.dumps(meta["radar"])) == AWR1843
    assert len(meta["assumed"]) == len(set(meta["assumed"])) > 2
    assert {"simulate", "reconstruct the room", "draw preview.png"} <= set(meta["seconds"])
    assert set(meta["files"]) == {file.name for file in walk.iterdir()}
    assert {"fx", "fy", "cx", "cy"} <= set(meta["camera"])


def test_the_person_nears_and_stands_on_the_floor(walk: Path, room: Room):
    pose = read_poses_npz(walk / "pose.npz")[0]
    distance_m = np.linalg.norm(pose.joints_m[:, 0], axis=1)
    assert distance_m[-1] < distance_m[0] - 0.15
    assert pose.joints_m[:, :, 2].min() == pytest.approx(room.scene.floor_z_m, abs=0.1)


def test_the_same_seed_gives_the_same_bits(walk: Path, tmp_path: Path):
    again = Weaver("physics", radar=AWR1843)
    made = again.generate(again.sample_room(), TEXT, frames=4, seed=3, keep_adc=True)
    made.save(tmp_path / "again", adc_data_bin=True)
    for name in ("radar.npz", "pose.npz", "points.npz", "adc_data.bin", "radar.json", "preview.png", "preview.gif"):
        assert (walk / name).read_bytes() == (tmp_path / "again" / name).read_bytes(), name


def test_the_network_is_the_default(room: Room, tmp_path: Path):
    made = Weaver().generate(room, TEXT, frames=2, seed=3)
    meta = made.save(tmp_path / "out")
    assert (meta["method"], made.adc) == ("weaver", None)
    assert "weave the signal" in meta["seconds"]
    named = Weaver("weaver").generate(room, TEXT, frames=2, seed=3)
    assert made.cube.values.tobytes() == named.cube.values.tobytes()


@pytest.mark.parametrize("method", ["weaver", "physics"])
@pytest.mark.parametrize(("radar", "texts"), [("awr1843", [TEXT, "a person stands"]), ("hupr", TEXT)])
def test_every_method_makes_samples_of_several_people_and_of_long_frames(
    room: Room, method: str, radar: str, texts: str | list[str]
):
    weaver = Weaver(method, radar)
    made, alone = (weaver.generate(room, texts, frames=2, keep_adc=keep) for keep in (True, False))
    assert made.cube.values.tobytes() == alone.cube.values.tobytes()
    assert made.adc is not None
    again = radar_cube(made.adc).values
    error = np.sum(np.abs(again - made.cube.values) ** 2) / np.sum(np.abs(made.cube.values) ** 2)
    assert 10 * np.log10(error + 1e-30) < -36
    assert made.meta["method"] == method


@pytest.mark.parametrize("method", ["weaver", "physics"])
def test_every_method_takes_a_background_recording(method: str, room: Room, tmp_path: Path):
    simulator = Simulator(room.scene, AWR1843, micro_seed=7)
    recording = radar_cube(simulator.run((), num_frames=4, seed=1).adc)
    write_radar_npz(tmp_path / "radar.npz", recording)
    (tmp_path / "radar.json").write_text(AWR1843.to_json())
    known, weaver = room.with_background(tmp_path), Weaver(method)
    made = weaver.generate(known, [TEXT, "a person stands"], frames=4, keep_adc=True)
    assert len(made.meta["inputs"]["background"]["sha256"]) == 64
    assert any("background recording" in sentence for sentence in made.meta["assumed"])
    same = weaver.generate(room.with_background(recording), [TEXT, "a person stands"], frames=4)
    assert np.allclose(made.cube.values, same.cube.values, rtol=1e-4, atol=1e-9)
    rest = AWR1843.num_loops // 2
    without = weaver.generate(room, [TEXT, "a person stands"], frames=4)
    known_static, sampled, recorded = (
        one.values[:, :, rest].mean(axis=0) for one in (made.cube, without.cube, recording)
    )
    # two people stand before it and occlude some of it, differently for each placement
    of_known, of_sampled = (
        float(np.median(np.abs(one - recorded) / np.abs(recorded))) for one in (known_static, sampled)
    )
    assert of_known < 0.8 < 0.95 < of_sampled
    assert made.adc is not None
    again = radar_cube(made.adc).values
    assert np.linalg.norm(again - made.cube.values) < 10 ** (-36 / 20) * np.linalg.norm(made.cube.values)
    with pytest.raises(InputError, match="other settings"):
        Weaver(method, radar="hupr").generate(known, TEXT, frames=2)
    with pytest.raises(InputError, match="does not exist"):
        room.with_background(tmp_path / "nowhere")


def test_firmware_points_leave_the_signal_as_it_is(weaver: Weaver, room: Room):
    board = Weaver(points="firmware").generate(room, TEXT, frames=4, seed=3, keep_adc=False)
    ours = Weaver().generate(room, TEXT, frames=4, seed=3, keep_adc=True)
    assert board.adc is None
    assert np.array_equal(board.cube.values, ours.cube.values)
    assert np.array_equal(board.points.x_m, firmware_points(ours.adc).x_m)
    with pytest.raises(InputError, match="known: cfar, firmware"):
        Weaver(points="lidar")
    with pytest.raises(InputError, match="use --points cfar"):
        Weaver(radar="bgt60", points="firmware")


def test_a_listener_hears_every_stage():
    heard: list[str] = []
    weaver = Weaver("physics", listener=heard.append)
    result = weaver.generate(weaver.sample_room(), TEXT, frames=1)
    assert heard == list(result.stages.seconds)


def test_several_people_each_with_a_body_and_a_place(weaver: Weaver, room: Room, tmp_path: Path):
    texts = ["a person walks towards the radar", "a woman sits and drinks", "a man claps"]
    result = weaver.generate(room, texts, frames=3, seed=1, at=[None, None, (0.6, 2.2)])
    assert len({pose.subject for pose in result.poses}) == 3
    assert len({pose.height_m for pose in result.poses}) == 3
    assert result.poses[2].joints_m[0, 0, :2] == pytest.approx([0.6, 2.2], abs=0.15)
    pelvises_m = np.array([motion.joints_m[:, 0, :2] for motion in result.motions])
    for one, other in ((0, 1), (0, 2), (1, 2)):
        assert np.linalg.norm(pelvises_m[one] - pelvises_m[other], axis=1).min() >= 0.5
    meta = result.save(tmp_path / "out", pictures=False)
    assert meta["text"] == texts
    assert "person" not in meta
    assert [person["height_m"] for person in meta["people"]] == [pose.height_m for pose in result.poses]
    assert any("multipath between people" in sentence for sentence in meta["assumed"])
    saved = read_poses_npz(tmp_path / "out" / "pose.npz")
    assert np.array([pose.joints_m for pose in saved]) == pytest.approx(
        np.array([pose.joints_m for pose in result.poses]), abs=1e-5
    )


@pytest.mark.parametrize("method", ["weaver", "physics"])
def test_an_empty_room_is_the_same_room_without_the_person(method: str, room: Room, tmp_path: Path):
    """It has no movement, and nearer than the person, who occludes nothing there, the same static clutter."""
    one = Weaver(method)
    empty, walk = (one.generate(room, text, frames=3, board="ideal") for text in ("nobody", TEXT))
    assert (empty.poses, empty.motions, empty.cube.values.shape) == ((), (), walk.cube.values.shape)
    still, moving = (np.abs(remove_static(result.cube, "mean_chirp").values).max() for result in (empty, walk))
    assert still < 0.02 * moving
    nearest_m = np.linalg.norm(walk.motion.joints_m, axis=-1).min()
    is_before = empty.cube.grid.range_m < nearest_m - 0.5
    still, same = (result.cube.values[:, is_before, 16] for result in (empty, walk))
    assert is_before.sum() > 5
    assert np.abs(still - same).mean() < 0.1 * np.abs(still).mean()
    meta = empty.save(tmp_path / "out", pictures=False)
    assert (meta["text"], meta["people"]) == ("nobody", [])
    assert "person" not in meta
    assert read_result(tmp_path / "out").poses == ()
    assert (tmp_path / "out" / "pose.npz").is_file()
    with pytest.raises(InputError, match="nobody is in"):
        _ = empty.pose


def test_another_method_plugs_in(room: Room, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    def ones(
        scene: Scene, poses: tuple[PoseSequence, ...], config: mmweaver.RadarConfig, *, num_frames: int, seed: int,
        keep_adc: bool, stages: Stages, background: RadarCube | None,
    ) -> Signal:  # fmt: skip
        grid = CubeGrid.of(config, num_frames)
        cube = RadarCube(values=np.ones(grid.shape, np.complex64), grid=grid, config=config, scale=1.0)
        return Signal(cube=cube, adc=None, assumptions=("all cells are one",))

    monkeypatch.setitem(METHODS._entries, "ones", lambda: ones)
    result = Weaver(method="ones").generate(room, TEXT, frames=2)
    assert result.meta["method"] == "ones"
    assert "all cells are one" in result.meta["assumed"]
    with pytest.raises(InputError, match="ADC"):
        result.save(tmp_path / "out", adc_data_bin=True)


def test_public_names_are_few_and_all_there():
    assert len(set(mmweaver.__all__) - {"__version__"}) <= 21
    for name in mmweaver.__all__:
        assert getattr(mmweaver, name) is not None
    assert set(mmweaver.__all__) <= set(dir(mmweaver))
    with pytest.raises(AttributeError, match="nope"):
        _ = mmweaver.nope


def test_a_recorded_motion_instead_of_a_sentence(tmp_path: Path):
    """The same clip twice gives the same bits; a text beside it only names it."""
    weaver = Weaver()
    room = weaver.sample_room()
    made = weaver.generate(room, "a person waves", frames=4, keep_adc=False)
    np.savez(tmp_path / "wave.npz", joints=made.motion.joints_m, fps=120.0)
    clip = weaver.read_motion(tmp_path / "wave.npz")
    one, same = (weaver.generate(room, "my wave", motion=clip, frames=3, keep_adc=False) for _ in range(2))
    assert np.array_equal(one.cube.values, same.cube.values)
    assert one.meta["text"] == "my wave"
    assert one.meta["inputs"]["motion"]["name"] == "wave.npz"
    assert one.pose.height_m == pytest.approx(made.pose.height_m, rel=0.03)
    tall = weaver.generate(room, motion=clip, height_m=1.9, frames=3, keep_adc=False)
    assert tall.pose.height_m == pytest.approx(1.9)
    assert weaver.generate(room, "a person waves", height_m=1.5, frames=2, keep_adc=False).pose.height_m == 1.5


def test_several_radars_record_the_same_scene(weaver: Weaver, room: Room, walk: Path, tmp_path: Path):
    there = mmweaver.RadarPose(x_m=1.4, y_m=1.6, yaw_deg=-70.0)
    made = weaver.generate(room, TEXT, frames=4, seed=3, radar_poses=[mmweaver.RadarPose(), there])
    here, elsewhere = made.radars
    assert here.cube.values.tobytes() == read_radar_npz(walk / "radar.npz").values.tobytes()
    np.testing.assert_allclose(there.in_level_frame(elsewhere.pose.joints_m), here.pose.joints_m, atol=1e-9)
    meta = made.save(tmp_path / "both", extra={"request.toml": "# none\n"})
    assert {"radar_1/radar.npz", "radar_2/preview.png"} <= set(meta["files"])
    assert json.loads((tmp_path / "both/radar_2/meta.json").read_text())["radar_pose"]["yaw_deg"] == -70
    assert verify(tmp_path / "both").is_sound
    with pytest.raises(InputError, match="not empty"):
        made.save(tmp_path / "both")
    with pytest.raises(InputError, match="at the camera"):
        elsewhere.save_html(tmp_path / "page.html")


def test_the_network_follows_the_radar(room: Room):
    """A radar that is turned sees the same echoes at another angle."""
    turned = mmweaver.RadarPose(yaw_deg=20.0)
    made = Weaver().generate(room, TEXT, frames=2, seed=3, radar_poses=[mmweaver.RadarPose(), turned])
    here, there = made.radars
    assert there.meta["method"] == "weaver"
    assert any("radars at the camera" in sentence for sentence in there.meta["assumed"])
    x, y = there.pose.joints_m[0, 0, :2]
    expected = np.sin(np.arctan2(x, y))
    angle = azimuth_axis_rad()
    power = range_azimuth_power(there.cube, angle, moving_only=True).sum(axis=(0, 1))
    assert np.sin(angle[power.argmax()]) == pytest.approx(expected, abs=0.2)
    assert not np.array_equal(here.cube.values, there.cube.values)


def test_the_person_has_the_errors_of_the_background_recording(room: Room):
    """Of a recording that shows them: a furnished room of many static cells, by a board with large errors."""
    config = replace(AWR1843, name="whole", first_range_bin=0, num_range_bins=256)
    own = Board(channel_gain_db=np.zeros((3, 4)), channel_phase_deg=np.array([[0, 60, -50, 0]] * 3, float))
    recording = radar_cube(Simulator(room.scene, config, board=own).run((), num_frames=4, seed=1).adc)
    weaver, known = Weaver(radar=config), room.with_background(recording)
    board, given = weaver.board_of(weaver.request(TEXT, frames=2), known)
    assert given == {"board": board}
    assert board.name == "of the background recording"
    assert not board.leakage_range_m.size
    found = board.channel_phase_deg.mean(axis=0)
    assert found[1] - found[2] == pytest.approx(110, abs=25)
    assert weaver.board_of(weaver.request(TEXT, frames=2, board="ideal"), known)[0].is_ideal


def test_a_background_that_came_with_its_board_is_by_that_board(weaver: Weaver, room: Room, tmp_path: Path):
    """Its gain, which no empty room shows, is the person's, too."""
    empty = weaver.generate(room, "nobody", frames=2, board="typical:3")
    empty.save(tmp_path / "empty")
    known = room.with_background(tmp_path / "empty")
    of_file = room.with_background(tmp_path / "empty" / "radar.npz")
    board, _ = weaver.board_of(weaver.request(TEXT, frames=2), known)
    assert weaver.board_of(weaver.request(TEXT, frames=2), of_file)[0].digest == board.digest
    assert board.gain_db == empty.board.gain_db < 0
    assert np.array_equal(board.channel_phase_deg, empty.board.channel_phase_deg)
    assert not board.leakage_range_m.size  # it is in the recording
