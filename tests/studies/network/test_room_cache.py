"""What was measured of a room is measured once for a setting, and again for another."""

from pathlib import Path

from studies.network.room_cache import RoomCache, digest


def test_a_room_is_measured_once_for_a_setting(tmp_path: Path):
    asked: list[str] = []

    def make(name: str):
        def made() -> dict[str, float]:
            asked.append(name)
            return {"accuracy": 0.1}

        return made

    for _ in range(2):
        cache = RoomCache(tmp_path, {"weights": "a"})  # as after a kill
        assert cache.figures("office_0", make("office_0")) == {"accuracy": 0.1}
    assert asked == ["office_0"]
    RoomCache(tmp_path, {"weights": "b"}).figures("office_0", make("other weights"))
    RoomCache(None, {}).figures("office_0", make("nothing cache"))
    assert asked == ["office_0", "other weights", "nothing cache"]


def test_files_that_differ_have_other_digests(tmp_path: Path):
    for name, text in (("a", "one"), ("b", "one"), ("c", "two")):
        (tmp_path / name).write_text(text)
    assert digest(tmp_path / "a") == digest(tmp_path / "b") != digest(tmp_path / "c")
