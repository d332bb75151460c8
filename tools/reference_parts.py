"""What the references freeze, part by part; each yields names and what makes their entries. See references.py."""

import ast
import gzip
import hashlib
import json
import re
import tempfile
import time
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import reference_adapter as code

ROOT = Path(__file__).resolve().parents[1]
GOLDEN = ROOT / "tests" / "golden"
TEXTS = (("a person waves with the left hand", 12), ("a man boxes quickly", 12),
         ("a person walks to the left, then squats", 30))  # fmt: skip
SEEDS = (0, 7)
PROCEDURAL_ROOMS = 60
PERSON = re.compile(
    r"^(?:(?:an?|the|one|another|some|this|two|three)\s+)?(?:\w+[\s-]){0,3}?(?:person|man|woman|boy|girl|lady|guy|user|"
    r"human|subject|someone|somebody|he|she|they|people|figure|child|kid|individual|patient|dancer|toddler|nurse)\s+\w",
    re.IGNORECASE,
)
Thunk = Callable[[], Any]


@dataclass(frozen=True, kw_only=True)
class Folders:
    """Real data, the folder of frozen inputs, and that of this run, which is the same while freezing."""

    data: Path
    base: Path
    own: Path


def sha(*arrays: Any) -> str:
    """16 digits of the sha256 of arrays (type, shape and bytes), texts or bytes."""
    total = hashlib.sha256()
    for one in arrays:
        if isinstance(one, np.ndarray):
            values = one if one.dtype.kind in "fciub" else np.array([str(text) for text in one.ravel()])
            total.update(f"{values.dtype}{values.shape}".encode() + np.ascontiguousarray(values).tobytes())
        else:
            total.update(one.encode() if isinstance(one, str) else one)
    return total.hexdigest()[:16]


def of_fields(record: Any) -> str:
    return sha(*(value for value in vars(record).values() if isinstance(value, np.ndarray)))


# cubes --------------------------------------------------------------------------------------------------------------
def signal(made: Any) -> dict[str, Any]:
    """Digests of a generated sequence or of a chunk of a stream."""
    power = float(np.sum(np.abs(made.cube.values.astype(complex)) ** 2))
    found = {
        "cube": sha(made.cube.values), "scale": sha(np.array(made.cube.scale)), "points": of_fields(made.points),
        "joints": sha(*(pose.joints_m for pose in made.poses)), "motion": sha(*(one.joints_m for one in made.motions)),
        "level_db": round(10 * np.log10(max(power, 1e-300)), 6),
    }  # fmt: skip
    return found if made.adc is None else {**found, "adc": sha(made.adc.samples)}


def cubes(folders: Folders) -> Iterator[tuple[str, Thunk]]:
    rooms = {"bundled": lambda: code.weaver("physics").sample_room(), "procedural": lambda: procedural(folders)}
    if (folders.data / "rooms").is_dir():
        for folder in sorted((folders.data / "rooms").iterdir()):
            rooms[folder.name] = lambda folder=folder: code.weaver("physics").open_room(folder)
    rooms["mesh"] = lambda: mesh_room(folders)
    kept: dict[str, Any] = {}

    def room_of(name: str) -> Any:
        if name not in kept:
            kept.clear()
            kept[name] = rooms[name]()
        return kept[name]

    def make(room: str, method: str, text: Any, radar: str = "awr1843", weaver: Any = None, **how: Any) -> Thunk:
        return lambda: signal(code.weaver(method, radar, **(weaver or {})).generate(room_of(room), text, **how))

    for room in rooms:
        for method in ("physics", "weaver"):
            for number, (text, frames) in enumerate(TEXTS):
                for seed in SEEDS:
                    adc = method == "physics" or seed == 0
                    yield f"{room}/{method}/{number}/{seed}", make(
                        room, method, text, frames=frames, seed=seed, keep_adc=adc
                    )  # fmt: skip
    (wave, n), (_, _), (walk, _) = TEXTS
    for method in ("physics", "weaver"):
        special = {
            "first order, resolved clutter": make(
                "bundled", method, wave, weaver={"bounces": 1, "clutter": "resolved"}, frames=n),
            "iwr1443_radhar, firmware points": make(
                "bundled", method, wave, "iwr1443_radhar", {"points": "firmware"}, frames=20, seed=3),
            "iwr6843isk": make("bundled", method, walk, "iwr6843isk", frames=n, seed=3),
            "ideal board": make("bundled", method, wave, frames=n, board="ideal"),
            "board typical:3": make("bundled", method, wave, frames=n, board="typical:3"),
            "several people": make("bundled", method, [wave, "a woman claps"], frames=n, seed=2),
            "nobody": make("bundled", method, "nobody", frames=n, seed=2),
            "subject, height, place": make(
                "bundled", method, wave, frames=n, subject=12, height_m=1.6, at=(0.1, 2.0), heading_rad=-1.2),
            "radar elsewhere": make("bundled", method, wave, frames=n, radar_poses=[code.another_place()]),
            "recorded motion": lambda m=method: signal(code.weaver(m).generate(
                room_of("bundled"), motion=code.motion_clip(folders.data), frames=n)),
            "background": lambda m=method: signal(code.weaver(m).generate(room_of("bundled").with_background(
                code.weaver("physics").generate(room_of("bundled"), "nobody", frames=n, seed=9).cube), wave, frames=n)),
            "stream": lambda m=method: stream(code.weaver(m), room_of("bundled")),
        }  # fmt: skip
        yield from ((f"special/{method}/{name}", thunk) for name, thunk in special.items())
    words = ("--rooms", "office,bedroom", "--layouts", 1, "--sequences", 2, "--frames", 4, "--seed", 3)
    yield "store/rooms", lambda: stored("dataset", *words)
    for iq in ("float16", "none"):
        yield f"store/activities, iq {iq}", lambda iq=iq: activity_set(iq)
    yield "store/adc_data.bin and what is processed of it", processed


def stream(weaver: Any, room: Any) -> list[Any]:
    texts = (TEXTS[2][0], TEXTS[0][0], None, "a person claps", "a person turns around", "a person squats", None, None)
    chunks, frames = [], 0
    for chunk in weaver.stream(room, texts, seed=4, chunk_frames=10):
        chunks.append(signal(chunk))
        frames += len(chunk.cube.values)
        if frames >= 60:
            break
    return chunks


def procedural(folders: Folders) -> Any:
    with tempfile.TemporaryDirectory() as place:
        code.command("rooms", Path(place, "r"), "--rooms", "living_room", "--seed", 5, "--noise")
        (folder,) = (one.parent for one in Path(place).rglob("rgb.png"))
        return code.weaver("physics").open_room(folder)


def mesh_room(folders: Folders) -> Any:
    import trimesh

    shell, sofa, table = (trimesh.creation.box(size) for size in ((5.0, 6.0, 2.6), (2.0, 0.8, 0.45), (0.6, 0.6, 1.0)))
    for part, place in ((shell, (2.5, 3.0, 1.3)), (sofa, (2.5, 5.4, 0.225)), (table, (0.6, 5.0, 0.5))):
        part.apply_translation(place)
    shell.invert()
    with tempfile.TemporaryDirectory() as place:
        trimesh.util.concatenate([shell, sofa, table]).export(f"{place}/room.ply")
        return code.weaver("physics").open_room(Path(place, "room.ply"))


def stored(*words: Any) -> dict[str, str]:
    """Digests of the arrays of a data set that a command writes; words[1:] follow its folder."""
    with tempfile.TemporaryDirectory() as place:
        code.command(words[0], Path(place, "set"), *words[1:], "--quiet")
        return {name: sha(values) for name, values in code.arrays_in(Path(place, "set"))}


def activity_set(iq: str) -> dict[str, str]:
    with tempfile.TemporaryDirectory() as place:
        file, room = Path(place, "a.toml"), Path(place, "rooms")
        file.write_text('[activities]\nwave = "a person waves"\nsquat = ["a person squats", "she squats quickly"]\n')
        code.command("rooms", room, "--rooms", "office", "--seed", 1)
        (folder,) = (one.parent for one in room.rglob("rgb.png"))
        return stored("dataset", "--activities", file, "--room", folder, "--per-class", 4, "--seconds", 2,
                      "--subjects", 2, "--iq", iq, "--seed", 2)  # fmt: skip


def processed() -> dict[str, str]:
    with tempfile.TemporaryDirectory() as place:
        one, two = Path(place, "one"), Path(place, "two")
        code.command("generate", "--demo", "--frames", 3, "--text", TEXTS[0][0], "--bin", "--seed", 5, "--no-pictures",
                     "--method", "physics", "--out", one)  # fmt: skip
        code.command("process", one / "adc_data.bin", "--radar", one / "radar.json", "--no-pictures", "--out", two)
        files = [one / "radar.npz", one / "points.npz", one / "pose.npz", two / "radar.npz", two / "points.npz"]
        return {"bin": sha((one / "adc_data.bin").read_bytes())} | {
            f"{file.parent.name}/{file.name}": arrays_of(file) for file in files
        }


def arrays_of(path: Path) -> str:
    """Of an .npz, the numbers without texts, which name versions and radars."""
    with np.load(path) as held:
        return sha(*(held[name] for name in sorted(held.files) if held[name].dtype.kind in "fciub"))


# steps --------------------------------------------------------------------------------------------------------------
def sources(data: Path) -> dict[str, list[str]]:
    """Sentences at hand, each once, by where they stand; the first that holds one has it."""
    found = {"kitml": code.kitml_sentences(data)} if (data / "motion" / "kitml_text").is_dir() else {}
    for path in sorted((ROOT / "studies").rglob("sentences/*.txt")):
        found[f"studies/{path.stem}"] = path.read_text(encoding="utf-8").splitlines()
    for top in ("tests", "studies", "examples", "benchmarks", "src"):
        found[top] = [text for path in sorted((ROOT / top).rglob("*")) for text in quoted(path) if PERSON.match(text)]
    pages = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
    found["docs"] = [text for path in pages for text in quoted(path) if PERSON.match(text)]
    found["results"] = [
        text for path in sorted((ROOT / "results").rglob("*.json")) for text in quoted(path) if PERSON.match(text)
    ]
    seen = {text.strip() for text in found.get("kitml", ())}
    for name, texts in found.items():
        if name != "kitml":  # which keeps its repeats: shares are of its 6,082
            found[name] = [one for one in dict.fromkeys(map(str.strip, texts)) if one and one not in seen]
            seen.update(found[name])
    return {name: texts for name, texts in found.items() if texts}


def quoted(path: Path) -> list[str]:
    """Strings of a file that may be sentences: of Python, without docstrings; else what stands in quotes."""
    if path.suffix == ".py":
        nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
        docs = {id(one.value) for one in nodes if isinstance(one, ast.Expr)}
        texts = [one.value for one in nodes if isinstance(one, ast.Constant) and id(one) not in docs]
    elif path.suffix in (".toml", ".md", ".json"):
        texts = re.findall(r'["“`]([^"“”`\n]+)["”`]', path.read_text(encoding="utf-8"))
    else:
        return []
    texts = [one for one in texts if isinstance(one, str) and not re.search(r"[{}<>_=\\\[\]|#`\n]", one)]
    return [one for one in texts if 3 <= len(one.split()) <= 60]


def steps(folders: Folders) -> Iterator[tuple[str, Thunk]]:
    frozen = folders.base / "sentences.json"
    if not frozen.exists():
        frozen.write_text(json.dumps(sources(folders.data), indent=0, ensure_ascii=False), encoding="utf-8")
    for name, texts in json.loads(frozen.read_text(encoding="utf-8")).items():
        yield name, lambda name=name, texts=texts: read_all(folders.own / f"steps_{name.replace('/', '_')}", texts)


def read_all(path: Path, texts: list[str]) -> dict[str, Any]:
    once = {text: code.steps_of(text) for text in dict.fromkeys(texts)}
    lines = [json.dumps({"text": text, **once[text]}, ensure_ascii=False, sort_keys=True) for text in texts]
    with gzip.GzipFile(f"{path}.jsonl.gz", "wb", mtime=0) as file:
        file.write("\n".join(lines).encode())
    reads = [once[text]["read"] for text in texts]
    count = {kind: reads.count(kind) for kind in ("whole", "in part", "refused")}
    return {"sentences": len(texts), **count, "steps": sha(json.dumps([once[text]["steps"] for text in texts]))}


# compression --------------------------------------------------------------------------------------------------------
def mmw(folders: Folders) -> Iterator[tuple[str, Thunk]]:
    made = folders.base / "mmw"
    if not made.is_dir():
        make_inputs(made)
    for path in sorted(made.glob("*/radar.npz")):
        cube = code.read_radar_npz(path)
        for effort in ("full", "fast"):
            asked = [{"num_bytes": cube.values.nbytes // ratio} for ratio in (1000, 200, 50)]
            for how in (*asked, {"quality_db": 25.0}, {"quality_db": 40.0, "keep_noise": True}):
                name = " ".join(f"{key} {value}" for key, value in how.items())
                yield (
                    f"{path.parent.name}/{effort}/{name}",
                    lambda cube=cube, how={**how, "effort": effort}: encoding(cube, how),
                )
    for error in (0, 2):
        yield f"lossless/max error {error}", lambda error=error: lossless(made / "box" / "adc_data.bin", error)
    for path in sorted(GOLDEN.glob("*.mmw")):
        yield f"golden/{path.name}", lambda path=path: sha(code.decoded(path))


def make_inputs(folder: Path) -> None:
    """Results of two radars and methods, one with the samples of a DCA1000; renamed into place when all are there."""
    with tempfile.TemporaryDirectory(dir=folder.parent) as place:
        for name, method, radar, text in (
            ("walk", "weaver", "awr1843", "a person walks to the left"), ("box", "physics", "awr1843", TEXTS[1][0]),
            ("clap", "physics", "iwr6843isk", "a person claps"),
        ):  # fmt: skip
            weaver = code.weaver(method, radar)
            made = weaver.generate(weaver.sample_room(), text, seconds=0.6, seed=1, keep_adc=name == "box")
            made.save(f"{place}/mmw/{name}", pictures=False, adc_data_bin=name == "box")
        Path(place, "mmw").replace(folder)


def encoding(cube: Any, how: dict[str, Any]) -> dict[str, Any]:
    began = time.process_time()
    data = code.encoded(cube, **how)
    seconds = round(time.process_time() - began, 3)
    return {"bytes": len(data), "sha": sha(data), **code.decoding_errors(data, cube), "seconds": seconds}


def lossless(recording: Path, max_error: int) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as place:
        file, again = Path(place, "a.mmwl"), Path(place, "a.bin")
        began = time.process_time()
        code.encoded_samples(recording, file, "awr1843", max_error)
        seconds = round(time.process_time() - began, 3)
        code.decoded_samples(file, again)
        found = {"bytes": file.stat().st_size, "sha": sha(file.read_bytes()), "decoded": sha(again.read_bytes())}
        return found | {"is_exact": again.read_bytes() == recording.read_bytes(), "seconds": seconds}


# placements, recognition, files -------------------------------------------------------------------------------------
def placements(folders: Folders) -> Iterator[tuple[str, Thunk]]:
    for index in range(PROCEDURAL_ROOMS):
        yield f"procedural/{index:02d}", lambda index=index: code.placements(index)


def radhar(folders: Folders) -> Iterator[tuple[str, Thunk]]:
    if not (folders.data / "pointclouds" / "radhar").is_dir():
        return
    yield "shipped recogniser", lambda: code.score_of_shipped(folders.data)


def files(folders: Folders) -> Iterator[tuple[str, Thunk]]:
    """The files of before, which no change of the code moves. Options of before are those of the commands here."""
    for archive in sorted((*GOLDEN.glob("*.zip"), *(GOLDEN / "before_house").glob("*.zip"))):
        yield archive.stem, lambda archive=archive: with_files_of(archive)


def with_files_of(archive: Path) -> dict[str, Any]:
    """What today's code reads in the files of an archive, and what it makes of their request.toml."""
    with tempfile.TemporaryDirectory() as place:
        with zipfile.ZipFile(archive) as held:
            held.extractall(place)
        return dict(read_files(Path(place)))


def read_files(top: Path) -> Iterator[tuple[str, Any]]:
    for path in sorted(top.rglob("*")):
        name = str(path.relative_to(top))
        if path.suffix == ".mmw":
            yield name, sha(code.decoded(path))
        elif path.suffix == ".mmwl":
            code.decoded_samples(path, top / "again.bin")
            yield name, sha((top / "again.bin").read_bytes())
        elif path.name == "radar.npz":
            cube = code.read_radar_npz(path)
            yield name, [sha(cube.values), sha(cube.grid.range_m, cube.grid.frame_time_s)]
        elif path.suffix == ".safetensors":
            yield name, sha(*(part for pair in code.weights_digestible(path) for part in pair))
        elif path.name == "request.toml":
            out = top / "again" / path.parent.name
            words = re.search(r'command = "([a-z ]+)"', path.read_text(encoding="utf-8"))
            code.command(*(words[1] if words else "generate").split(), "--config", path, *made_where(path, out))
            made = [*out.rglob("*.npz")]
            yield name, {str(file.relative_to(out)): arrays_of(file) for file in sorted(made)} or "runs"
        elif path.name == "trees.npz":
            for points in sorted(top.glob("people/*/*.npz")):
                yield f"{name} {points.stem}", sha(code.recognised(path.parent, points))
    for folder in sorted({path.parent for path in top.rglob("SHA256SUMS")}):
        yield (
            f"verify {folder.relative_to(top)}",
            json.loads(code.command("verify", folder, "--json")).get("damaged", []),
        )
    for name, values in code.arrays_in(top):
        yield f"zarr {name}", sha(values)


def made_where(request: Path, out: Path) -> tuple[Any, ...]:
    text = request.read_text(encoding="utf-8")
    return (out,) if 'command = "dataset"' in text or 'command = "rooms"' in text else ("--out", out)


PARTS = {"cubes": cubes, "steps": steps, "mmw": mmw, "placements": placements, "radhar": radhar, "files": files}
