"""Pictures and a video of the studio for docs/studio.md and the README: a scripted session in Chromium.

    python tools/studio_pictures.py                  # docs/images/studio_*.png
    python tools/studio_pictures.py --video          # and docs/images/studio.mp4, half a minute

Needs what tests/browser needs, and PyAV for the video.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from fractions import Fraction
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from mmweaver.scene.procedural.procedural_room import make_room  # noqa: E402
from tests.browser.chromium import FLAGS, IDLE, READY, needs_browser, running_studio  # noqa: E402
from tests.io.point_clouds.test_read_points import packet  # noqa: E402

IMAGES = ROOT / "docs" / "images"
FRAME_RATE_HZ, VIDEO_S = 10, 30
SIZE: Any = {"width": 1440, "height": 900}


def main() -> None:
    """Takes the pictures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--video", action="store_true", help="write the video too")
    arguments = parser.parse_args()
    path = needs_browser()
    from playwright.sync_api import sync_playwright

    with (
        tempfile.TemporaryDirectory() as log,
        running_studio(log=Path(log) / "log") as address,
        sync_playwright() as playwright,
    ):
        chromium = playwright.chromium.launch(executable_path=path, args=FLAGS)
        page = chromium.new_page(viewport=SIZE, bypass_csp=True, reduced_motion="reduce")
        page.goto(address)
        page.wait_for_selector(READY, timeout=180_000)
        take_pictures(page)
        take_pictures_of_files(page, Path(log))
        if arguments.video:
            page.goto(address)
            page.reload()
            page.wait_for_selector(READY, timeout=180_000)
            write_video(IMAGES / "studio.mp4", film(page, Path(log) / "living_room.glb"))
        chromium.close()


def take_pictures(page: Any) -> None:
    """One picture of each state that docs/studio.md shows."""
    ask(page, "a person walks towards the radar, then waves with the left hand")
    page.evaluate("studio.player.seek(9)")
    take(page, "studio")
    page.get_by_role("button", name="Compare").click()
    page.locator("select[aria-label=Method]").select_option("physics")
    page.wait_for_selector(IDLE, timeout=120_000)
    page.evaluate("studio.player.seek(9)")
    take(page, "studio_compare")
    page.get_by_role("button", name="Numbers").click()
    page.wait_for_selector("dialog[open]", timeout=60_000)
    take(page, "studio_numbers")
    page.get_by_role("button", name="Close").click()
    page.get_by_role("button", name="Compare").click()
    page.locator("select[aria-label=Method]").select_option("auto")
    page.wait_for_selector(IDLE, timeout=120_000)
    ask(page, "a person walks to the left")
    page.evaluate("studio.player.seek(8)")
    show_cell(page)
    take(page, "studio_rays")
    page.evaluate("studio.player.setRays(false)")
    draw_path(page)
    page.evaluate("studio.player.seek(12)")
    take(page, "studio_path")
    page.get_by_role("button", name="Details").click()
    take(page, "studio_details")
    page.get_by_role("button", name="Close").click()
    page.evaluate("studio.follow({change: {path: null}})")
    page.wait_for_selector(IDLE, timeout=120_000)
    ask(page, "a person juggles five balls while riding a unicycle")
    take(page, "studio_clauses")
    ask(page, "a person walks behind the sofa")
    take(page, "studio_error")
    ask(page, "a person claps")
    page.get_by_role("button", name="Live").click()
    page.wait_for_function("() => studio.live?.frames > 60", timeout=120_000)
    take(page, "studio_live")
    page.get_by_role("button", name="Stop").click()
    ask(page, "a person sits down")
    page.emulate_media(color_scheme="dark")
    page.set_viewport_size({"width": 3840, "height": 2160})
    page.wait_for_timeout(500)
    take(page, "studio_4k")
    page.set_viewport_size({"width": 390, "height": 1500})
    page.wait_for_timeout(500)
    take(page, "studio_phone")
    page.set_viewport_size(SIZE)
    page.emulate_media(color_scheme="light")


def take_pictures_of_files(page: Any, folder: Path) -> None:
    """What becomes of a mesh, of a data port's log, and of a room without a floor."""
    ask(page, "a person walks to the right")
    points = (
        page.evaluate("[...studio.result.arrays.points.data]"),
        page.evaluate("[...studio.result.arrays.point_frame.data]"),
    )
    write_port_log(folder / "xwr18xx.dat", np.reshape(points[0], (-1, 5)), np.array(points[1]))
    drop(page, [folder / "xwr18xx.dat"])
    page.evaluate("studio.player.seek(9)")
    take(page, "studio_points")
    write_mesh(folder / "living_room.glb")
    drop(page, [folder / "living_room.glb"])
    page.evaluate("studio.player.seek(12)")
    take(page, "studio_mesh")
    Image.fromarray(np.full((480, 640, 3), 180, np.uint8)).save(folder / "rgb.png")
    Image.fromarray(np.full((480, 640), 450, np.uint16)).save(folder / "depth.png")
    drop(page, [folder / "rgb.png", folder / "depth.png"])
    take(page, "studio_no_floor")


def show_cell(page: Any) -> None:
    """Clicks the cell of range-azimuth in which the person is."""
    place = page.evaluate("studio.result.joint(0, studio.player.frame, 0)")
    box = page.locator("canvas[aria-label^='Range-azimuth']").bounding_box()
    x, y = page.evaluate(f"(c => [c.px({place[0]}), c.py({place[1]})])(studio.player.panel('range_azimuth'))")
    page.mouse.click(box["x"] + x, box["y"] + y)
    page.wait_for_function("studio.player.scene.raysDrawn > 0")


def drop(page: Any, files: list[Path]) -> None:
    """Uploads files and waits for what comes of them."""
    given = [{"name": file.name, "data": list(file.read_bytes())} for file in files]
    page.evaluate("files => studio.upload(files.map(f => new File([new Uint8Array(f.data)], f.name)))", given)
    page.wait_for_selector(IDLE, timeout=120_000)


def write_port_log(file: Path, points: np.ndarray, frame: np.ndarray) -> None:
    """Points (point, 5) and their frames as the out-of-box demo sends them."""
    packets = []
    for number in range(int(frame.max()) + 1):
        rows = points[frame == number]
        side = np.stack([10 * rows[:, 4], np.zeros(len(rows))], axis=-1).astype("<i2")  # SNR in 0.1 dB
        tlvs = [(1, rows[:, :4].astype("<f4").tobytes()), (7, side.tobytes())]
        packets.append(packet(number, tlvs, len(rows)))
    file.write_bytes(b"".join(packets))


def write_mesh(file: Path) -> None:
    """A furnished procedural room as GLB, y up."""
    import trimesh

    mesh, scene = make_room("living_room", 0, 3).mesh, trimesh.Scene()
    for number, appearance in enumerate(mesh.appearances):
        part: Any = trimesh.Trimesh(mesh.vertices_m, mesh.faces[mesh.appearance == number], process=False)
        part.remove_unreferenced_vertices()
        rgb = (255 * np.clip(appearance.colour, 0, 1) ** (1 / 2.2)).astype(np.uint8)
        part.visual.vertex_colors = np.tile([*rgb, 255], (len(part.vertices), 1)).astype(np.uint8)
        part.apply_transform(np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]))
        scene.add_geometry(part, geom_name=f"{appearance.coco}.{number:03d}")
    scene.export(str(file))


def ask(page: Any, text: str) -> None:
    """Types a sentence and presses Enter."""
    page.locator(".sentence").first.fill(text)
    page.locator(".sentence").first.press("Enter")
    page.wait_for_timeout(50)
    page.wait_for_selector(IDLE, timeout=120_000)


def draw_path(page: Any, wait: Callable[[], None] = lambda: None) -> None:
    """Draws a path over the floor of the bundled room."""
    page.get_by_role("button", name="Draw path").click()
    places = [page.evaluate(f"studio.player.scene.toPage({x}, {y})") for x, y in ((0.3, 2.3), (0.3, 1.5), (0.7, 1.4))]
    page.mouse.move(*places[0])
    page.mouse.down()
    for place in places[1:]:
        page.mouse.move(*place, steps=12)
        wait()
    page.mouse.up()
    page.wait_for_selector(IDLE, timeout=120_000)


def take(page: Any, name: str) -> None:
    """A picture of the page, as a palette PNG: a third of the bytes."""
    page.wait_for_timeout(300)
    picture = Image.open(BytesIO(page.screenshot()), formats=["PNG"]).convert("RGB")
    picture.quantize(192, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(
        IMAGES / f"{name}.png", optimize=True
    )


def film(page: Any, mesh: Path) -> Iterator[np.ndarray]:
    """Pictures (height, width, 3) of a session, FRAME_RATE_HZ a second of its playback; `mesh` is a room to drop."""

    def shot() -> np.ndarray:
        return np.asarray(
            Image.open(BytesIO(page.screenshot(type="jpeg", quality=92)), formats=["JPEG"]).convert("RGB")
        )

    def held(seconds: float) -> Iterator[np.ndarray]:
        picture = shot()
        yield from [picture] * round(seconds * FRAME_RATE_HZ)

    def played() -> Iterator[np.ndarray]:
        for frame in range(page.evaluate("studio.result.frames")):
            page.evaluate(f"studio.player.seek({frame})")
            yield shot()

    def typed(text: str) -> Iterator[np.ndarray]:
        box = page.locator(".sentence").first
        box.fill("")
        for end in range(4, len(text) + 4, 4):
            box.fill(text[:end])
            yield shot()
        ask(page, text)

    yield from held(1.5)
    yield from played()
    yield from typed("a person sits down, then drinks water")
    yield from played()
    yield from typed("a person walks to the left")
    draw_path(page)
    yield from held(0.7)
    yield from played()
    page.get_by_role("button", name="Compare").click()
    page.locator("select[aria-label=Method]").select_option("physics")
    page.wait_for_selector(IDLE, timeout=120_000)
    yield from played()
    page.get_by_role("button", name="Numbers").click()
    page.wait_for_selector("dialog[open]", timeout=120_000)
    yield from held(2.5)
    page.get_by_role("button", name="Close").click()
    page.get_by_role("button", name="Compare").click()
    page.locator("select[aria-label=Method]").select_option("auto")
    page.wait_for_selector(IDLE, timeout=120_000)
    page.evaluate("studio.follow({change: {path: null}})")
    page.wait_for_selector(IDLE, timeout=120_000)
    drop(page, [mesh])
    yield from played()
    yield from typed("a person squats")
    yield from played()
    page.locator("select[aria-label=Room]").select_option("demo")
    page.wait_for_selector(IDLE, timeout=120_000)
    page.get_by_role("button", name="Live").click()
    page.wait_for_function("() => studio.live?.frames > 30", timeout=120_000)
    for _ in range(6 * FRAME_RATE_HZ):
        yield shot()


def write_video(file: Path, pictures: Iterator[np.ndarray]) -> None:
    """Encodes at most VIDEO_S seconds as H.264."""
    import av

    begun = time.monotonic()
    with av.open(str(file), "w") as container:
        stream: Any = container.add_stream(
            "libx264", rate=Fraction(FRAME_RATE_HZ), options={"crf": "32", "preset": "slow"}
        )
        stream.width, stream.height, stream.pix_fmt = SIZE["width"], SIZE["height"], "yuv420p"
        count = 0
        for picture in pictures:
            if count == VIDEO_S * FRAME_RATE_HZ:
                break
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
            count += 1
        container.mux(stream.encode())
    print(
        f"{file.name}: {count / FRAME_RATE_HZ:.0f} s, {file.stat().st_size:,} bytes, {time.monotonic() - begun:.0f} s"
    )


if __name__ == "__main__":
    main()
