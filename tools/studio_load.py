"""Clients of the studio, a tenth of them hostile: is every honest one answered, and does memory stay bounded?

python tools/studio_load.py --clients 200 --seconds 600
"""

import argparse
import asyncio
import contextlib
import json
import os
import random
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import httpx

TEXTS = ("a person walks to the left", "a person claps", "a person sits down", "a person waves", "a person squats")
BOARDS = tuple(f"typical:{number}" for number in range(12))
PAUSE_S = 20.0  # between two sequences of an honest client
PATIENCE_S = 300.0


class Load:
    """What became of the requests."""

    def __init__(self, port: int, until: float):
        self.port, self.until = port, until
        self.answered: list[float] = []  # seconds of each honest request
        self.failed: Counter[str] = Counter()
        self.hostile: Counter[str] = Counter()

    def is_over(self) -> bool:
        return time.monotonic() > self.until

    async def honest(self, number: int) -> None:
        """Loads the page, and makes one sequence after another until the time is over."""
        rng = random.Random(number)
        await asyncio.sleep(rng.uniform(0, PAUSE_S))
        async with httpx.AsyncClient(base_url=f"http://127.0.0.1:{self.port}", timeout=PATIENCE_S) as page:
            own: dict[str, str] = {}
            while not self.is_over():
                start = time.monotonic()
                try:
                    if not own:
                        own = {"x-session": (await page.post("/api/session")).json()["session"]}
                        await page.get("/api/room/demo", headers=own)
                    body = {"room": "demo", "text": [rng.choice(TEXTS)], "seed": number, "board": rng.choice(BOARDS)}
                    answer = await page.post("/api/generate", json=body, headers=own)
                    if answer.status_code == 200 and len(answer.content) > 10_000:
                        self.answered.append(time.monotonic() - start)
                    else:
                        self.failed[f"{answer.status_code} {answer.text[:80]}"] += 1
                        own = own if answer.status_code == 503 else {}
                except (httpx.HTTPError, json.JSONDecodeError, KeyError) as error:
                    self.failed[type(error).__name__] += 1
                await asyncio.sleep(rng.uniform(0.5, 1.5) * PAUSE_S)

    async def attack(self, number: int) -> None:
        """One kind of mischief after another, until the time is over."""
        rng = random.Random(-number)
        kinds = [self._half_open, self._slow_body, self._large_body, self._sessions, self._uploads, self._leaves,
                 self._frames, self._no_reader]  # fmt: skip
        while not self.is_over():
            kind = rng.choice(kinds)
            with contextlib.suppress(OSError, httpx.HTTPError, asyncio.IncompleteReadError, TimeoutError, KeyError):
                self.hostile[kind.__name__[1:]] += 1
                await asyncio.wait_for(kind(rng), 30)
            await asyncio.sleep(rng.uniform(0.1, 2.0))

    async def _half_open(self, rng: random.Random) -> None:
        pairs = [await asyncio.open_connection("127.0.0.1", self.port) for _ in range(40)]
        await asyncio.sleep(rng.uniform(1, 12))
        for _, writer in pairs:
            writer.close()

    async def _slow_body(self, rng: random.Random) -> None:
        _, writer = await asyncio.open_connection("127.0.0.1", self.port)
        writer.write(b"POST /api/generate HTTP/1.1\r\nhost: 127.0.0.1\r\ncontent-length: 5000\r\n\r\n")
        for _ in range(20):
            writer.write(b"{")
            await writer.drain()
            await asyncio.sleep(1)
        writer.close()

    async def _large_body(self, rng: random.Random) -> None:
        _, writer = await asyncio.open_connection("127.0.0.1", self.port)
        writer.write(b"POST /api/generate HTTP/1.1\r\nhost: 127.0.0.1\r\ncontent-length: 1000000000\r\n\r\n")
        for _ in range(200):
            writer.write(bytes(1_000_000))
            await writer.drain()
        writer.close()

    async def _sessions(self, rng: random.Random) -> None:
        async with self._page() as page:
            for _ in range(30):
                await page.post("/api/session")

    async def _uploads(self, rng: random.Random) -> None:
        async with self._page() as page:
            own = {"x-session": (await page.post("/api/session")).json()["session"]}
            names = json.dumps(rng.choice([["a", "a/b"], ["\U0001f600" * 80, "x"], ["../../x", "/etc/y"]]))
            files = [("files", (name, rng.randbytes(rng.choice((10, 2_000_000))))) for name in ("x.bin", "y.npz")]
            await page.post("/api/upload", files=files, data={"radar": "awr1843", "paths": names}, headers=own)

    async def _leaves(self, rng: random.Random) -> None:
        async with self._page() as page:
            own = {"x-session": (await page.post("/api/session")).json()["session"]}
            body = {"room": "demo", "text": ["a person claps"], "seed": rng.randrange(99)}
            with contextlib.suppress(httpx.ReadTimeout):
                await page.post("/api/generate", json=body, headers=own, timeout=rng.uniform(0.01, 1))

    async def _frames(self, rng: random.Random) -> None:
        import websockets

        async with self._page() as page:
            name = (await page.post("/api/session")).json()["session"]
        for path in ("presence", "live"):
            with contextlib.suppress(websockets.WebSocketException):
                url = f"ws://127.0.0.1:{self.port}/api/{path}?session={name}"
                async with websockets.connect(url) as client:
                    await client.send(rng.choice((b"\xff\0", "[]", "x" * 500_000, '{"text": "a person waves"}')))
                    await asyncio.sleep(rng.uniform(0, 2))

    async def _no_reader(self, rng: random.Random) -> None:
        _, writer = await asyncio.open_connection("127.0.0.1", self.port, limit=1024)
        for _ in range(50):
            writer.write(b"GET /page/mmweaver.js HTTP/1.1\r\nhost: 127.0.0.1\r\n\r\n")
        await asyncio.sleep(20)
        writer.close()

    def _page(self) -> httpx.AsyncClient:
        return httpx.AsyncClient(base_url=f"http://127.0.0.1:{self.port}", timeout=30)


async def run(port: int, process: int, clients: int, seconds: float) -> tuple[Load, list[int]]:
    """Runs all clients; returns what became of them, and the memory of the server every second, MB."""
    load, memory = Load(port, time.monotonic() + seconds), list[int]()

    async def watch() -> None:
        while not load.is_over():
            with contextlib.suppress(OSError, StopIteration):
                lines = Path(f"/proc/{process}/status").read_text().splitlines()
                memory.append(int(next(line for line in lines if line.startswith("VmRSS")).split()[1]) // 1024)
            await asyncio.sleep(1)

    hostile = clients // 10
    await asyncio.gather(watch(), *map(load.honest, range(clients - hostile)), *map(load.attack, range(1, hostile + 1)))
    return load, memory


def main() -> int:
    """Prints what became of the clients; exit status 1 if an honest one was not answered."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--clients", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=600.0)
    asked = parser.parse_args()
    command = [sys.executable, "-m", "mmweaver", "studio", "--no-browser", "--port", "0"]
    with tempfile.TemporaryDirectory() as place, (Path(place) / "stderr").open("w+") as errors:
        environment = {**os.environ, "TMPDIR": place}
        server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True, env=environment)
        assert server.stdout is not None
        line = next(line for line in server.stdout if "ready" in line)
        port = int(re.findall(r":(\d+)/", line)[0])
        load, memory = asyncio.run(run(port, server.pid, asked.clients, asked.seconds))
        time.sleep(15)
        left = [path.name for path in Path(place).iterdir() if path.name != "stderr"]
        sockets = len(list(Path(f"/proc/{server.pid}/fd").iterdir()))
        server.terminate()
        server.wait(30)
        after = [path.name for path in Path(place).iterdir() if path.name != "stderr"]
        errors.seek(0)
        text = errors.read()
    times = sorted(load.answered)
    print(f"honest requests answered: {len(times)}, not answered: {load.failed.total()} {dict(load.failed)}")
    if times:
        print(f"seconds to an answer: median {times[len(times) // 2]:.1f}, longest {times[-1]:.1f}")
    print(f"hostile requests: {load.hostile.total()} {dict(load.hostile)}")
    print(
        f"memory of the server, MB: at first {memory[0]}, median {sorted(memory)[len(memory) // 2]}, most {max(memory)}"
    )
    print(f"session folders after the load: {len(left)}, open files: {sockets}; after its end: {after}")
    print(f"tracebacks: {text.count('Traceback')}; lines on stderr: {Counter(text.splitlines()).most_common(5)}")
    return int(bool(load.failed) or "Traceback" in text)


if __name__ == "__main__":
    sys.exit(main())
