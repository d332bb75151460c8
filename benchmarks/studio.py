"""The studio: when it is ready from cold, when a page shows its first data, how soon new data comes, Live's speed.

A studio in a process of its own, asked as its page asks; where Chromium is there, by the page too (software rendering).
Writes results/benchmark/studio.json and prints the same.
"""

import json
import os
import sys
import tempfile
import time
import urllib.request
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from measuring import report, results_folder

from tests.browser.chromium import CHROMIUM, FLAGS, running_studio

SENTENCES = (
    "a person walks to the left", "a person claps", "a person sits down", "a person waves with the left hand",
    "a person squats", "a person walks towards the radar", "a person turns around",
)  # fmt: skip
LIVE_FRAMES = 200


def cpu_seconds(pid: int) -> float:
    """Processor time of a process, all threads."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def browser_cpu_seconds() -> float:
    """Processor time of Chromium: of every process below this one that is part of it."""
    parents, chromium = {}, set()
    for folder in Path("/proc").iterdir():
        try:
            if folder.name.isdigit():
                fields = (folder / "stat").read_text(encoding="ascii", errors="replace").rsplit(")", 1)[1].split()
                parents[int(folder.name)] = int(fields[1])
                if b"chrom" in (folder / "cmdline").read_bytes().split(b"\0")[0]:
                    chromium.add(int(folder.name))
        except OSError:  # a process that has ended meanwhile
            continue
    own = {os.getpid()}
    while grown := {pid for pid, parent in parents.items() if parent in own} - own:
        own |= grown
    return sum(cpu_seconds(pid) for pid in chromium & own)


def post(address: str, path: str, session: str = "", body: object = None) -> bytes:
    """What a call of the page answers."""
    asked = urllib.request.Request(address + path, json.dumps(body or {}).encode(), {"x-session": session})
    with urllib.request.urlopen(asked, timeout=120) as answer:
        return answer.read()


def of_server(address: str, pid: int) -> dict[str, float]:
    """The first answer after ready, and those to more sentences."""
    begun = time.perf_counter()
    session = json.loads(post(address, "api/session"))["session"]
    wall_s, cpu_s, sizes = [], [], []
    for text in SENTENCES:
        cpu, wall = cpu_seconds(pid), time.perf_counter()
        sizes.append(len(post(address, "api/generate", session, {"room": "demo", "text": [text]})))
        wall_s.append(time.perf_counter() - (wall if wall_s else begun))
        cpu_s.append(cpu_seconds(pid) - cpu)
    return {
        "first_answer_wall_s": wall_s[0], "new_data_median_wall_s": float(np.median(wall_s[1:])),
        "new_data_slowest_wall_s": max(wall_s[1:]), "new_data_median_cpu_s": float(np.median(cpu_s[1:])),
        "answer_megabytes": float(np.median(sizes)) / 1e6,
    }  # fmt: skip


def of_page(address: str, pid: int) -> dict[str, float]:
    """The page in a browser, from asking for it to its first data; a sentence typed; and twenty seconds live."""
    try:
        from playwright.sync_api import sync_playwright
    except ModuleNotFoundError:
        return {}
    if CHROMIUM is None:
        return {}
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=[*FLAGS, "--js-flags=--expose-gc"])
        page = chromium.new_page(viewport={"width": 1280, "height": 860}, bypass_csp=True)
        begun = time.perf_counter()
        page.goto(address)
        page.wait_for_selector("main[data-state=ready]", timeout=180_000)
        found = {"page_ready_wall_s": time.perf_counter() - begun}
        seconds = []
        for text in SENTENCES[:5]:
            page.locator(".sentence").first.fill(text)
            page.locator(".sentence").first.press("Enter")
            page.wait_for_function("text => studio.result.header.meta.text === text", arg=text, timeout=120_000)
            seconds.append(page.evaluate("studio.lastSeconds"))
        found["page_new_data_median_wall_s"] = float(np.median(seconds))
        page.get_by_role("button", name="Live").click()
        page.wait_for_function("() => studio.live?.frames > 40", timeout=120_000)
        cpu, early = cpu_seconds(pid), page.evaluate("(gc(), performance.memory.usedJSHeapSize)")
        frames, drawn, begun = (
            page.evaluate("studio.live.frames"),
            page.evaluate("studio.player.scene.draws"),
            time.perf_counter(),
        )
        in_browser = browser_cpu_seconds()
        page.wait_for_function(f"() => studio.live.frames > {LIVE_FRAMES}", timeout=300_000)
        wall_s, browser_s, draws = (
            time.perf_counter() - begun, browser_cpu_seconds() - in_browser,
            page.evaluate("studio.player.scene.draws") - drawn,
        )  # fmt: skip
        served_s = cpu_seconds(pid) - cpu
        made_s = 0.1 * (page.evaluate("studio.live.frames") - frames)
        late = page.evaluate("(gc(), performance.memory.usedJSHeapSize)")
        found |= {
            "live_times_real_time_wall": page.evaluate("studio.live.times_real_time"),
            "live_times_real_time_cpu": made_s / served_s,
            "live_browser_cpu_per_second": browser_s / wall_s,
            "live_server_cpu_per_second": served_s / wall_s,
            "live_pictures_per_second": draws / wall_s,
            "live_heap_growth_megabytes": (late - early) / 1e6,
        }  # fmt: skip
        chromium.close()
    return found


def main() -> int:
    out = results_folder(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        begun = time.perf_counter()
        with running_studio(log=Path(folder) / "log") as address:
            ready = {"ready_wall_s": time.perf_counter() - begun, "ready_cpu_s": cpu_seconds(address.pid)}
            values = ready | of_server(address, address.pid) | of_page(address, address.pid)
            values["resident_gb"] = address.memory_mb / 1024
    config = {"sentences": list(SENTENCES), "threads": 1, "load": os.getloadavg()[0]}
    report(out, "studio", {"name": "bundled sample room, network"}, values, config)
    return 0


if __name__ == "__main__":
    sys.exit(main())
