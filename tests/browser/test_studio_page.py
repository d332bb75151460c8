"""The studio in a real browser, as a visitor uses it."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from mmweaver.io.dca1000 import write_bin
from tests import captures
from tests.browser.chromium import IDLE, READY, Running
from tests.scene.scanned_mesh.test_mesh_photo import Y_UP, furnished

SAMPLE = Path(__file__).resolve().parents[2] / "src" / "mmweaver" / "sample"


def ask(page: Any, text: str) -> str:
    """Types a sentence, presses Enter, and gives the status line."""
    page.locator(".sentence").first.fill(text)
    page.locator(".sentence").first.press("Enter")
    page.wait_for_selector("main[data-busy=true], main[data-busy=false]")
    page.wait_for_selector(IDLE, timeout=60_000)
    return said(page)


def said(page: Any) -> str:
    """The status line, and the problem if there is one."""
    return page.inner_text(".status") + (page.inner_text(".problem") if page.locator(".problem").is_visible() else "")


def drop(page: Any, files: list[Path]) -> None:
    """Drops files on the page, and waits until they are read."""
    dropped = """files => { const transfer = new DataTransfer();
        for (const f of files) transfer.items.add(new File([new Uint8Array(f.data)], f.name));
        const event = new DragEvent('drop', {dataTransfer: transfer, bubbles: true, cancelable: true});
        studio.root.dispatchEvent(event); }"""
    page.evaluate("studio.dispatch({type: 'note', text: 'dropping'}), studio.dispatch({type: 'dismiss'})")
    page.evaluate(dropped, [{"name": file.name, "data": list(file.read_bytes())} for file in files])
    page.wait_for_function(f"""document.querySelector('{IDLE}') &&
        (studio.state.problem || !document.querySelector('.status').innerText.includes('dropping'))""")


def test_no_request_leaves_this_machine(visited: tuple[Any, list[str], list[str]], address: str):
    _, asked, complaints = visited
    assert len(asked) >= 4
    assert all(url.startswith((address, "data:", "blob:")) for url in asked)
    assert complaints == []


def test_the_room_is_drawn(page: Any):
    assert page.evaluate("studio.player.scene.paintedShare()") > 0.05


def test_a_sentence_makes_new_data(page: Any):
    assert "s of radar in" in ask(page, "a person walks to the left")
    assert page.evaluate("studio.result.header.meta.text") == "a person walks to the left"


def test_an_unknown_sentence_shows_why_and_keeps_the_result(page: Any):
    before = ask(page, "a person walks to the left") and page.evaluate("studio.result.header.result")
    told = ask(page, "a person flies")
    assert "names no activity" in told
    assert page.get_attribute(".problem", "data-code") == "sentence"
    assert page.evaluate("studio.result.header.result") == before
    assert page.inner_text(".shown-title") == "a person walks to the left"  # the page says what the picture is of


def test_a_click_on_the_floor_moves_the_start(page: Any):
    ask(page, "a person waves with the left hand")
    target = page.evaluate("studio.player.room.nearestStandable(-0.1, 2.1).place")
    x, y = page.evaluate(f"studio.player.scene.toPage({target[0]}, {target[1]})")
    page.mouse.click(x, y)
    page.wait_for_selector(IDLE, timeout=60_000)
    start = page.evaluate("studio.result.header.meta.person.starts_at_m")
    assert math.dist(start, target) < 0.05
    assert "m right and" in said(page)


def test_a_click_where_nobody_can_stand_takes_the_nearest_place(page: Any):
    wall = page.evaluate("studio.player.room.nearestStandable(-5, 9).place")
    beyond = [wall[0], wall[1] + 0.5]
    x, y = page.evaluate(f"studio.player.scene.toPage({beyond[0]}, {beyond[1]})")
    page.mouse.click(x, y)
    page.wait_for_selector(IDLE, timeout=60_000)
    assert "nearest free place is" in page.inner_text(".status")
    at = page.evaluate("studio.state.ask.people[0].at")
    assert page.evaluate(f"studio.player.room.nearestStandable({at[0]}, {at[1]}).distance") < 0.05
    page.evaluate("studio.follow({change: {at: null}})")
    page.wait_for_selector(IDLE, timeout=60_000)


def test_a_path_is_drawn_on_the_floor(page: Any):
    ask(page, "a person walks to the left")
    page.get_by_role("button", name="Draw path").click()
    corners = [[0.3, 2.3], [0.3, 1.5], [0.7, 1.4]]
    places = [page.evaluate(f"studio.player.scene.toPage({x}, {y})") for x, y in corners]
    page.mouse.move(*places[0])
    page.mouse.down()
    for place in places[1:]:
        page.mouse.move(*place, steps=12)
    page.mouse.up()
    page.wait_for_selector(IDLE, timeout=60_000)
    assert "s of radar in" in said(page)
    asked = page.evaluate("studio.state.ask.people[0].path")
    assert 2 <= len(asked) <= 5  # corners, not every place of the pointer
    assert math.dist(asked[0], corners[0]) < 0.1
    assert math.dist(page.evaluate("studio.result.header.meta.person.ends_at_m"), asked[-1]) < 0.1
    page.evaluate("studio.startAt([0.3, 2.0])")
    page.wait_for_selector(IDLE, timeout=60_000)
    page.evaluate("studio.follow({change: {at: null}})")
    page.wait_for_selector(IDLE, timeout=60_000)


def test_scrubbing_moves_all_panels(page: Any):
    box = page.locator("canvas[role=slider]").bounding_box()
    page.mouse.click(box["x"] + 50 + 0.5 * (box["width"] - 58), box["y"] + box["height"] / 2)
    frames = page.evaluate("studio.player.shownFrames()")
    assert len(set(frames.values())) == 1
    assert 8 <= frames["scene"] <= 12


def test_a_cursor_is_read_in_all_panels(page: Any):
    box = page.locator("canvas[aria-label^='Range-Doppler']").bounding_box()
    near, far = page.evaluate("studio.player.sequence.header.range_m")
    height = box["height"] - 54
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 22 + 0.6 * height)
    arc_m = page.evaluate("studio.player.scene.arcRangeM()")
    assert abs(arc_m - (near + 0.4 * (far - near))) < 0.02 + (far - near) / height  # and a pixel
    for other in ("range_azimuth", "range_profile", "range_time"):
        assert abs(arc_m - page.evaluate(f"studio.player.panel('{other}').cursor.range")) < 0.02
    assert "dBm" in page.locator("figure:has(canvas[aria-label^='Range-Doppler']) output").inner_text()
    assert f"{arc_m:.2f} m" in page.inner_text(".reading")
    page.mouse.move(5, 5)
    assert page.evaluate("studio.player.scene.arcRangeM()") is None


def test_the_keyboard_plays_and_steps(page: Any):
    page.locator("canvas[role=slider]").focus()
    page.keyboard.press("Home")
    page.keyboard.press("ArrowRight")
    assert page.evaluate("studio.player.frame") == 1
    page.keyboard.press(" ")
    assert page.evaluate("studio.player.playing")
    page.keyboard.press(" ")
    assert not page.evaluate("studio.player.playing")


def test_files_that_are_dropped_become_a_room(page: Any):
    drop(page, [file for file in sorted(SAMPLE.iterdir()) if file.suffix != ".md"])
    assert "s of radar in" in said(page)
    assert page.evaluate("studio.player.room.header.name") == "your room 1"


def test_hostile_files_leave_one_line(page: Any):
    page.evaluate("studio.upload([new File(['no picture'], 'rgb.png'), new File(['none'], 'depth.png')])")
    page.wait_for_selector(".problem", timeout=60_000)
    assert page.get_attribute(".problem", "data-code") == "upload"
    assert "s of radar in" in ask(page, "a person sits down")


def test_compare_shows_both_and_their_difference(page: Any):
    page.get_by_role("button", name="Compare").click()
    ask(page, "a person walks to the right for 4 seconds")
    assert page.locator(".maps canvas[aria-label]").count() == 9
    titles = page.evaluate("[...document.querySelectorAll('.player figure canvas[aria-label]')].map(c => c.ariaLabel)")
    assert sum(title.startswith("B \N{MINUS SIGN} A: ") for title in titles) == 5
    page.evaluate("studio.player.seek(Infinity)")  # the longer one sets the time line
    assert page.evaluate("studio.player.frame") == page.evaluate("studio.result.frames") - 1 > 30
    assert len(set(page.evaluate("studio.player.shownFrames()").values())) == 1


def test_the_numbers_are_those_of_compare(page: Any):
    page.get_by_role("button", name="Numbers").click()
    page.wait_for_selector("dialog[open]", timeout=60_000)
    told = page.inner_text("dialog")
    assert "effect size" in told
    assert "decibels: " in told
    page.get_by_role("button", name="Close").click()


def test_a_recording_is_compared_with_a_simulation(page: Any, tmp_path: Path):
    """Of another board, with other ranges, velocities and decibels."""
    config = captures.radar_of_cfg(tmp_path)
    write_bin(tmp_path / "adc_data.bin", captures.counts(config), counts_per_unit=1.0)
    drop(page, [tmp_path / "made.cfg", tmp_path / "adc_data.bin"])
    assert "adc_data.bin" in page.inner_text(".shown-title")
    assert "over noise" in page.inner_text(".colour-bar")
    panel = "studio.player.panel('range_doppler', 'difference')"
    near = page.evaluate("Math.max(...[studio.player.sequence, studio.result].map(one => one.header.range_m[0]))")
    page.evaluate(f"{panel}.onHover({{range: {near + 0.3}, velocity: 0}})")
    assert page.evaluate(f"{panel}.root.querySelector('output').textContent").endswith(" dB")
    page.get_by_role("button", name="Compare").click()
    assert page.locator(".maps canvas[aria-label]").count() == 3
    assert "s of radar in" in ask(page, "a person walks to the right")
    assert page.evaluate("studio.player.room !== null")


def test_the_link_restores_the_state(page: Any, browser: Any):
    ask(page, "a person claps")
    page.locator(".seed").fill("7")
    page.locator(".seed").press("Tab")
    page.wait_for_selector(IDLE, timeout=60_000)
    page.locator("select[aria-label=Room]").select_option("demo")
    page.wait_for_selector(IDLE, timeout=60_000)
    url = page.url
    again = browser.new_page(reduced_motion="reduce")
    again.goto(url)
    again.wait_for_selector(READY, timeout=120_000)
    assert again.evaluate("studio.result.header.meta.text") == "a person claps"
    assert again.evaluate("studio.result.header.meta.seed") == 7
    again.close()


def test_the_details_repeat_the_run(page: Any):
    page.get_by_role("button", name="Details").click()
    told = page.inner_text("dialog")
    assert "mmweaver generate" in told
    assert "from mmweaver import Weaver" in told
    page.get_by_role("button", name="Close").click()


@pytest.mark.parametrize(("width", "theme"), [(1280, "light"), (390, "dark")])
def test_everything_has_a_name_and_fits(page: Any, width: int, theme: str):
    page.set_viewport_size({"width": width, "height": 860})
    page.emulate_media(color_scheme=theme)
    nameless = page.evaluate("""[...document.querySelectorAll('button, select, textarea, input, canvas')]
        .filter(e => e.tabIndex >= 0 && e.offsetParent !== null)
        .filter(e => !(e.getAttribute('aria-label') || e.textContent.trim() || e.closest('label')?.textContent.trim()))
        .map(e => e.outerHTML)""")
    assert nameless == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.set_viewport_size({"width": 1280, "height": 860})
    page.emulate_media(color_scheme="light")


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_no_serious_fault(page: Any, theme: str):
    axe = pytest.importorskip("axe_playwright_python", reason="axe-playwright-python is not installed")
    (script,) = Path(axe.__file__).parent.rglob("axe.min.js")
    page.emulate_media(color_scheme=theme)
    page.evaluate(script.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run()")["violations"]
    page.emulate_media(color_scheme="light")
    serious = {one["id"]: one["nodes"][0]["html"] for one in found if one["impact"] in ("serious", "critical")}
    assert serious == {}


def test_live_runs_on_and_takes_sentences(page: Any):
    ask(page, "a person stands")
    page.get_by_role("button", name="Live").click()
    page.wait_for_function("() => studio.live?.frames > 10", timeout=60_000)
    page.locator(".sentence").first.fill("a person claps")
    page.locator(".sentence").first.press("Enter")
    page.wait_for_function("() => studio.live?.text.includes('clap')", timeout=60_000)
    largest = page.evaluate("""(() => { const {data, shape} = studio.result.arrays.joints; let top = 0;
        for (let f = 1; f < shape[1]; f++) for (let c = 0; c < 3; c++)
            top = Math.max(top, Math.abs(data[f * 66 + c] - data[(f - 1) * 66 + c]));
        return top; })()""")
    assert largest < 0.2  # metres in a tenth of a second: the pelvis does not jump
    assert page.evaluate("studio.result.frames") <= 200
    page.get_by_role("button", name="Stop").click()
    assert "s of radar in" in ask(page, "a person waves")


@pytest.mark.slow  # test_live_runs_on_and_takes_sentences and tests/studio/test_live.py hold the parts
def test_twenty_seconds_live(page: Any, address: Running):
    """Without jumps, in memory that does not grow; how fast: `make bench` (benchmarks/studio.py)."""
    ask(page, "a person walks to the left")
    page.get_by_role("button", name="Live").click()
    heap, resident = [], []
    for seconds, text in ((8, "a person claps"), (14, "a person walks to the right"), (20, "a person sits down")):
        page.wait_for_function(f"() => studio.live?.frames > {10 * seconds}", timeout=120_000)
        page.evaluate("window.gc && gc()")
        heap.append(page.evaluate("performance.memory.usedJSHeapSize") / 1e6)
        resident.append(address.memory_mb)
        page.locator(".sentence").first.fill(text)
        page.locator(".sentence").first.press("Enter")
    page.wait_for_function("() => studio.live.frames > 220", timeout=120_000)
    page.get_by_role("button", name="Stop").click()
    assert heap[-1] - heap[0] < 30, heap
    assert resident[-1] - resident[0] < 60, resident


def test_a_room_without_a_floor_offers_recovery_options(page: Any, tmp_path: Path):
    """A wall at 0.45 m fills the picture: nobody can stand before it."""
    Image.fromarray(np.full((480, 640, 3), 180, np.uint8)).save(tmp_path / "rgb.png")
    np.save(tmp_path / "depth.npy", np.full((480, 640), 0.45, np.float32))
    drop(page, [tmp_path / "rgb.png", tmp_path / "depth.npy"])
    page.wait_for_selector(".problem button", timeout=60_000)
    assert page.get_attribute(".problem", "data-code") in ("no_room", "room")
    assert page.evaluate("studio.player.scene.people") == 0  # nobody of the room before stands in this one
    page.get_by_role("button", name="in the bundled room").click()
    page.wait_for_selector(IDLE, timeout=60_000)
    assert page.evaluate("studio.player.scene.people") == 1
    assert "s of radar in" in said(page)


def test_a_mesh_becomes_a_room(page: Any, tmp_path: Path):
    drop(page, [furnished(tmp_path / "room.glb", Y_UP)])
    assert "s of radar in" in said(page)
    assert "--room room.glb" in page.evaluate("studio.result.header.command")
    page.locator("select[aria-label=Room]").select_option("demo")
    page.wait_for_selector(IDLE, timeout=60_000)


def test_the_keyboard_moves_the_start_and_walks_a_path(page: Any):
    ask(page, "a person waves")
    page.locator(".scene canvas").focus()
    start = page.evaluate("studio.result.header.meta.person.starts_at_m")
    page.keyboard.press("Shift+ArrowLeft")
    page.wait_for_function("at => String(studio.result.header.meta.person.starts_at_m) !== String(at)", arg=start)
    moved = page.evaluate("studio.result.header.meta.person.starts_at_m")
    assert math.dist(moved, start) < 0.4  # a step, or the nearest free place
    assert moved != start
    ask(page, "a person walks to the left")
    page.get_by_role("button", name="Draw path").click()
    page.evaluate("""studio.state = {...studio.state, ask: {...studio.state.ask,
        people: [{...studio.state.ask.people[0], at: [0.3, 2.2]}]}}""")
    page.locator(".scene canvas").focus()
    page.keyboard.press("Enter")
    for _ in range(7):
        page.keyboard.press("Shift+ArrowDown")
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Walk path").click()
    page.wait_for_selector(IDLE, timeout=60_000)
    assert math.dist(page.evaluate("studio.result.header.meta.person.ends_at_m"), [0.3, 1.5]) < 0.15
    page.evaluate("studio.follow({change: {path: null}})")
    page.wait_for_selector(IDLE, timeout=60_000)


def test_hovering_the_body_marks_its_cells(page: Any):
    ask(page, "a person waves")
    page.evaluate("studio.player.seek(5), studio.player.scene.draw()")  # at once, for the ray that finds the body
    x, y = page.evaluate("""(() => { const p = studio.result.joint(0, 5, 0), v = studio.player.scene;
        const c = v.camera.position.clone().set(p[0], p[1], p[2]).project(v.camera);
        const box = v.renderer.domElement.getBoundingClientRect();
        return [box.left + (c.x + 1) / 2 * box.width, box.top + (1 - c.y) / 2 * box.height]; })()""")
    page.mouse.move(x, y)
    page.wait_for_function("studio.player.panel('range_doppler').marks.length")
    marks = page.evaluate("studio.player.panel('range_doppler').marks")
    near, far = marks[0]["y"]
    pelvis_m = page.evaluate("Math.hypot(...studio.result.joint(0, 5, 0))")
    assert near < pelvis_m < far < near + 1.5
    assert marks[0]["x"][0] < marks[0]["x"][1]
    page.mouse.move(5, 5)
    assert page.evaluate("studio.player.panel('range_doppler').marks") == []


def test_the_notebook_widget_plays(page: Any):
    """As anywidget calls it: the bundle's default export renders the bytes of the model."""
    canvases = page.evaluate("""async () => {
        const bundle = await import(document.querySelector('script[src]').src), el = document.createElement('div');
        const path = 'api/result/' + studio.result.header.result, headers = {'x-session': studio.api.session};
        const bytes = new DataView(await (await fetch(path, {headers})).arrayBuffer());
        document.body.append(el);
        const dispose = bundle.default.render({model: {get: name => name === 'sequence' ? bytes : null}, el});
        const canvases = el.querySelectorAll('figure canvas[aria-label]').length;
        dispose(); el.remove();
        return canvases; }""")
    assert canvases == 5


def test_the_offline_page_plays(page: Any, browser: Any, tmp_path: Path):
    result = page.evaluate("studio.result.header.result")
    content = page.evaluate(
        f"fetch('api/export/{result}/html', {{headers: {{'x-session': studio.api.session}}}}).then(r => r.text())"
    )
    (tmp_path / "walk.html").write_text(content, encoding="utf-8")
    context = browser.new_context(offline=True, reduced_motion="reduce")
    alone = context.new_page()
    complaints: list[str] = []
    alone.on("pageerror", lambda error: complaints.append(str(error)))
    alone.goto((tmp_path / "walk.html").as_uri())
    alone.wait_for_selector(".maps canvas[aria-label]")
    alone.evaluate("player.play()")
    alone.wait_for_selector("button[aria-label=Pause]")
    assert alone.evaluate("player.scene.paintedShare()") > 0.05
    assert json.loads(alone.evaluate("JSON.stringify(player.sequence.header.frames)")) == 20
    assert complaints == []
    context.close()


def test_a_click_on_a_cell_shows_the_paths_that_made_it(page: Any):
    ask(page, "a person walks to the left")
    page.evaluate("studio.player.seek(8)")
    pelvis = page.evaluate("studio.result.joint(0, 8, 0)")
    box = page.locator("canvas[aria-label^='Range-azimuth']").bounding_box()
    x, y = page.evaluate(f"(c => [c.px({pelvis[0]}), c.py({pelvis[1]})])(studio.player.panel('range_azimuth'))")
    page.mouse.click(box["x"] + x, box["y"] + y)
    page.wait_for_function("studio.player.scene.raysDrawn > 0 && !document.querySelector('.rays').hidden")
    told = page.inner_text(".rays")
    assert "in this cell" in told
    assert "body: " in told
    assert " dBm" in told
    few = page.evaluate("studio.player.scene.raysDrawn")
    page.keyboard.press("Escape")
    page.wait_for_function(f"studio.player.scene.raysDrawn > {few}")
    page.keyboard.press("r")
    page.wait_for_function("studio.player.scene.raysDrawn === 0")


def test_what_was_not_done_is_next_to_the_picture(page: Any):
    ask(page, "a person juggles five balls while riding a unicycle")
    chips = page.locator(".facts .clause")
    clauses = page.evaluate("studio.result.header.meta.clauses")
    assert chips.count() == len(clauses) >= 2
    assert page.locator(".facts .approximated, .facts .not-done").count() == sum(c["status"] != "done" for c in clauses)
    assert "dBm" in page.inner_text(".facts .noise")


def test_warnings_of_a_recording_are_next_to_the_picture(page: Any):
    page.evaluate("""(() => { const {sequence} = studio.player;
        const meta = {...sequence.header.meta, warnings: ['stripes: read with --radar of another board']};
        sequence.header = {...sequence.header, meta}; studio.player.show(sequence); })()""")
    assert "stripes" in page.inner_text(".facts .warning")
    assert "--" not in page.inner_text(".facts")


def test_a_landmark_is_shown_by_a_click(page: Any):
    ask(page, "a person walks to the door")
    assert "no door is in the picture" in page.inner_text(".facts .approximated")
    page.get_by_role("button", name="show where the door is").click()
    x, y = page.evaluate("studio.player.scene.toPage(0.5, 2.2)")
    page.mouse.click(x, y)
    page.wait_for_selector(IDLE, timeout=60_000)
    assert "s of radar in" in said(page)
    assert "--landmark=door=" in page.evaluate("studio.result.header.command")
    page.evaluate("studio.dispatch({type: 'edit', change: {landmarks: []}})")
    ask(page, "a person waves")


def test_back_and_forward_go_through_what_was_made(page: Any):
    ask(page, "a person claps")
    ask(page, "a person sits down")
    page.go_back()
    page.wait_for_function("() => studio.state.phase === 'idle' && studio.state.shown?.name === 'a person claps'")
    assert page.locator(".sentence").first.input_value() == "a person claps"
    page.go_forward()
    page.wait_for_function("() => studio.state.phase === 'idle' && studio.state.shown?.name === 'a person sits down'")


def test_a_keyboard_alone_reaches_and_does_everything(page: Any, browser: Any):
    """Every control takes the focus by Tab, and shortcuts work wherever it is; on a page of its own."""
    url, page = page.url, browser.new_page(reduced_motion="reduce")
    page.goto(url)
    page.wait_for_selector(READY, timeout=120_000)
    page.wait_for_selector(IDLE, timeout=60_000)
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("/")
    assert page.evaluate("document.activeElement.className") == "sentence"
    page.keyboard.type("a person claps")
    page.keyboard.press("Enter")
    page.wait_for_function("() => studio.state.phase === 'idle' && studio.state.shown?.name === 'a person claps'")
    reached = set()
    for _ in range(60):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement.outerHTML.slice(0, 120)"))
    wanted = page.evaluate("""[...document.querySelectorAll(
        'button, select, textarea, input, canvas[tabindex], summary')]
        .filter(e => e.tabIndex >= 0 && e.checkVisibility({contentVisibilityAuto: true}) && !e.disabled)
        .map(e => e.outerHTML.slice(0, 120))""")
    assert set(wanted) - reached == set()
    page.locator(".sentence").first.focus()
    page.keyboard.press("Escape")
    frame = page.evaluate("studio.player.frame")
    page.keyboard.press("ArrowRight")
    assert page.evaluate("studio.player.frame") == frame + 1
    for key, state in (("m", "studio.player.settings.value.moving"), ("l", "studio.player.settings.value.loop")):
        before = page.evaluate(state)
        page.keyboard.press(key)
        assert page.evaluate(state) != before
        page.keyboard.press(key)
    page.keyboard.press("?")
    page.wait_for_selector("dialog[open] kbd")
    for _ in range(10):
        page.keyboard.press("Escape")
        page.wait_for_timeout(300)  # closing gives the focus back
        if not page.evaluate("document.querySelector('dialog[open]') !== null"):
            break
    for _ in range(20):  # a dialog that closes late takes the focus back
        page.locator("canvas[aria-label^='Range-Doppler']").focus()
        page.keyboard.press("Shift+ArrowUp")
        page.wait_for_timeout(100)
        if "m/s" in page.inner_text(".reading"):
            break
    assert "m/s" in page.inner_text(".reading")
    page.keyboard.press("Enter")
    page.wait_for_function("studio.player.cell !== null")
    page.keyboard.press("Escape")
    page.evaluate("studio.player.setRays(false)")
    page.close()


def test_theme_and_layout_are_kept(page: Any, browser: Any, address: Running):
    context = browser.new_context(reduced_motion="reduce")
    own = context.new_page()
    own.goto(address)
    own.wait_for_selector(READY, timeout=120_000)
    own.keyboard.press("t")
    own.keyboard.press("p")
    theme = own.evaluate("[...studio.root.classList].sort().join()")
    own.reload()
    own.wait_for_selector(READY, timeout=120_000)
    assert own.evaluate("[...studio.root.classList].sort().join()") == theme
    assert "folded" in theme
    context.close()


@pytest.mark.parametrize("width", [390, 1440, 3840])
def test_targets_and_letters_fit_the_screen(page: Any, width: int):
    page.set_viewport_size({"width": width, "height": round(width * 0.6) if width > 390 else 844})
    page.wait_for_timeout(200)
    scene, window = page.locator(".scene").bounding_box(), page.evaluate("innerWidth")
    small = page.evaluate("""[...document.querySelectorAll('button, select, summary')]
        .filter(e => e.offsetParent !== null && e.getBoundingClientRect().height < 43.5)
        .map(e => [e.outerHTML.slice(0, 80), e.getBoundingClientRect().height])""")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert width > 390 or small == []
    assert scene["width"] >= (0.45 if width > 390 else 0.9) * window  # most of the width is the room's
    page.set_viewport_size({"width": 1280, "height": 860})


@pytest.mark.slow  # half a minute in software rendering
def test_pictures_of_the_panels_are_saved(page: Any):
    ask(page, "a person waves")
    for kind, start in (("page-png", b"\x89PNG"), ("page-svg", b"<svg")):
        with page.expect_download() as waited:
            page.locator("select[aria-label=Export]").select_option(kind)
        assert Path(waited.value.path()).read_bytes().startswith(start)
