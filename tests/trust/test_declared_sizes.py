"""What a file declares is held against the bytes that are there, before memory is taken."""

import json
import struct
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import MAX_DEPTH, read_toml
from mmweaver.motion.mocap.joint_arrays import MAX_FRAMES
from mmweaver.motion.mocap.read_motion import read_motion
from tests.fuzz import mutators as m
from tests.fuzz.harness import Reader, Report, try_case

CASES = Path(__file__).resolve().parents[2].parent / "shared" / "cases" / "hostile"
TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4").tobytes()


def refused(read: Callable[[Path], Any], path: Path, *, within_mb: float = 100, within_s: float = 2) -> str:
    """The one line that refuses a file, in little memory and time."""
    begun, message = time.process_time(), ""
    tracemalloc.start()
    try:
        read(path)
    except InputError as error:
        message = str(error)
    finally:
        peak_mb = tracemalloc.get_traced_memory()[1] / 1e6
        tracemalloc.stop()
    assert message, f"{path.name} is accepted"
    assert peak_mb < within_mb
    assert time.process_time() - begun < 20 * within_s  # traced, and on a busy machine
    return message


# TOML -------------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    "text",
    [
        "a." * 20_000 + "a = 1\n", '"a" . ' * 20_000 + "a = 1\n", "[" + "a." * 20_000 + "a]\n",
        "[['" + "'.'".join("a" * 5000) + "']]\n", "x = {" + "b." * 60 + "c = 1}\n",
        "".join(".".join(f"k{line}_{part}" for part in range(50)) + " = 1\n" for line in range(2000)),
        "a = " + "[" * 20_000, 's = """\na.b"""\n' + "'c'." * 60 + "d = 1",
    ],
)  # fmt: skip
def test_toml_of_deep_keys_is_refused_before_it_is_parsed(tmp_path: Path, text: str):
    (tmp_path / "a.toml").write_text(text)
    refused(read_toml, tmp_path / "a.toml")


@pytest.mark.parametrize(
    "text",
    [
        f"{'a.' * (MAX_DEPTH - 3)}b = 1\n", f"a = [{'1.5, ' * 500}]\n", 'a = "' + "x.y" * 500 + '"\n',
        'a = """\n' + 'b."c".d\n' * 100 + '"""\n', "a = 'C:\\\\" + "x.y" * 100 + "'\n", "# " + "a." * 500 + "\na = 1\n",
        'a = ["' + '", "'.join(["a.b.c"] * 200) + '"]\n', "t = 1979-05-27T07:32:00.999\n", '"a\\".b" = 1\n',
    ],
)  # fmt: skip
def test_toml_with_dots_elsewhere_is_read(tmp_path: Path, text: str):
    import tomllib

    (tmp_path / "a.toml").write_text(text)
    assert read_toml(tmp_path / "a.toml") == tomllib.loads(text)


# GLB --------------------------------------------------------------------------------------------------------------
def glb(change: Callable[[dict[str, Any]], None], body: bytes = TRIANGLE) -> bytes:
    """One triangle, changed."""
    header: dict[str, Any] = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(body)}], "buffers": [{"byteLength": len(body)}],
    }  # fmt: skip
    change(header)
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(body), 0x004E4942) + body
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _accessor(**values: Any) -> Callable[[dict[str, Any]], None]:
    return lambda header: header["accessors"][0].update(values)


def _without_view(header: dict[str, Any]) -> None:
    del header["accessors"][0]["bufferView"]
    header["accessors"][0]["count"] = 30_000_000


def _many_nodes(header: dict[str, Any]) -> None:
    header["nodes"] = [{"mesh": 0} for _ in range(200_000)]
    header["meshes"][0]["primitives"] *= 100


def _shared_child(header: dict[str, Any]) -> None:
    header["nodes"] = [{"children": [number + 1, number + 1]} for number in range(40)] + [{"mesh": 0}]


GLBS = {
    "no view": _without_view, "count": _accessor(count=10**9), "negative": _accessor(count=-1),
    "sparse": _accessor(sparse={"count": 10**9}), "offset": _accessor(byteOffset=10**9), "type": _accessor(type="VEC9"),
    "stride": lambda header: header["bufferViews"][0].update(byteStride=1) or _accessor(count=20)(header),
    "nodes": _many_nodes, "shared child": _shared_child, "no list": lambda header: header.update(nodes={"a": 1}),
    "view": lambda header: header["bufferViews"][0].update(byteLength=10**12) or _accessor(count=10**10)(header),
}  # fmt: skip


def _read_mesh(path: Path) -> Any:
    from mmweaver.scene.scanned_mesh.read_mesh import read_mesh

    return read_mesh(path)


def test_a_glb_of_a_triangle_is_read(tmp_path: Path):
    pytest.importorskip("trimesh", reason="the extra 'mesh' is not installed")
    (tmp_path / "a.glb").write_bytes(glb(lambda _: None))
    assert len(_read_mesh(tmp_path / "a.glb").faces) == 1


@pytest.mark.parametrize("what", GLBS)
def test_a_glb_that_declares_more_than_it_holds_is_refused(tmp_path: Path, what: str):
    pytest.importorskip("trimesh", reason="the extra 'mesh' is not installed")
    (tmp_path / "a.glb").write_bytes(glb(GLBS[what]))
    refused(_read_mesh, tmp_path / "a.glb")


def test_views_are_not_copied_many_times(tmp_path: Path):
    """300 accessors of one view: a file of 1 MB would take 300."""
    pytest.importorskip("trimesh", reason="the extra 'mesh' is not installed")
    body = TRIANGLE * 30_000

    def copied(header: dict[str, Any]) -> None:
        header["accessors"][0]["count"] = 90_000
        header["accessors"] *= 300

    (tmp_path / "a.glb").write_bytes(glb(copied, body))
    assert "accessors say" in refused(_read_mesh, tmp_path / "a.glb")


@pytest.mark.parametrize("kind", ["EPS", "large"])
def test_textures_have_the_decoders_and_limits_of_pictures(tmp_path: Path, kind: str, monkeypatch: pytest.MonkeyPatch):
    """An EPS would reach Ghostscript; trimesh reads a mesh without a texture that it cannot open."""
    trimesh = pytest.importorskip("trimesh", reason="the extra 'mesh' is not installed")
    from PIL import EpsImagePlugin

    reached: list[Any] = []
    monkeypatch.setattr(EpsImagePlugin.EpsImageFile, "load", lambda *_: reached.append(1))
    size = (64, 64) if kind == "EPS" else (9000, 9000)
    picture = tmp_path / "a.png"
    Image.new("RGB", size).save(picture, kind if kind == "EPS" else "PNG")
    mesh = trimesh.creation.box()
    (tmp_path / "a.mtl").write_text("newmtl m\nmap_Kd a.png\n")
    lines = ["mtllib a.mtl", "usemtl m", "vt 0 0", "vt 1 0", "vt 1 1"]
    lines += [f"v {x} {y} {z}" for x, y, z in mesh.vertices]
    lines += ["f " + " ".join(f"{corner + 1}/{place + 1}" for place, corner in enumerate(face)) for face in mesh.faces]
    (tmp_path / "a.obj").write_text("\n".join(lines) + "\n")
    tracemalloc.start()
    assert len(_read_mesh(tmp_path / "a.obj").faces) == 12
    assert tracemalloc.get_traced_memory()[1] < 50e6
    tracemalloc.stop()
    assert reached == []


# motions ----------------------------------------------------------------------------------------------------------
def test_a_motion_that_is_too_long_is_refused_before_it_is_read(tmp_path: Path):
    """A file without bytes on the disk: only its header is looked at."""
    path = tmp_path / "long.npy"
    head = m.lying_npy(f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({MAX_FRAMES + 1}, 22, 3), }}")
    path.write_bytes(head)
    with path.open("r+b") as file:
        file.truncate(len(head) + (MAX_FRAMES + 1) * 264)
    assert str(MAX_FRAMES) in refused(lambda file: read_motion(file, fps=20.0), path, within_mb=5)


def test_values_that_overflow_are_one_line(tmp_path: Path, recwarn: pytest.WarningsRecorder):
    np.save(tmp_path / "a.npy", np.full((4, 22, 3), 3e38, "f4") * np.array([1, -1, 1], "f4"))
    assert "outside" in refused(lambda file: read_motion(file, fps=20.0), tmp_path / "a.npy")
    assert not [warning for warning in recwarn if issubclass(warning.category, RuntimeWarning)]


# the inputs of the issue ------------------------------------------------------------------------------------------
@pytest.mark.skipif(not CASES.is_dir(), reason="../shared/cases/hostile is absent")
@pytest.mark.parametrize("name", ["001_glb_traceback_m.glb", "glb_accessor_without_view_3e7.glb",
                                  "toml_dotted_key_20000.toml", "motion_npy_several_lines_m.npy"])  # fmt: skip
def test_the_collected_cases_are_refused_at_once(name: str, tmp_path: Path):
    read = {".glb": _read_mesh, ".toml": read_toml, ".npy": lambda path: read_motion(path, fps=20.0)}[Path(name).suffix]
    report = Report(name=name)
    reader = Reader(name=name, suffix=Path(name).suffix, damaged=lambda _: b"", read=read)
    try_case(reader, tmp_path / name, (CASES / name).read_bytes(), report)
    assert not report.failures, dict(report.failures)
    assert report.refused == 1
    assert report.peak_mb < 100
