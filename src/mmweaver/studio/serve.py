"""Runs the studio's server: binds, prints the address, opens the browser once it is ready."""

import secrets
import socket
import webbrowser
from collections.abc import Callable
from pathlib import Path

import uvicorn

from mmweaver.core.errors import InputError
from mmweaver.studio.server import LOOPBACK, StudioServer
from mmweaver.studio.service import Service


class _Announcing(uvicorn.Server):
    """Announces when it is ready to answer."""

    def __init__(self, config: uvicorn.Config, address: str, announce: Callable[[str], None], open_browser: bool):
        super().__init__(config)
        self._address, self._announce, self._open = address, announce, open_browser

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        self._announce(f"mmweaver studio is ready: {self._address}   (Ctrl+C ends it)")
        if self._open:
            webbrowser.open(self._address)


def serve(
    rooms: list[Path],
    recordings: list[Path],
    recognisers: list[Path],
    *,
    host: str,
    port: int,
    workers: int | None,
    announce: Callable[[str], None],
    open_browser: bool,
) -> None:
    """Serves until interrupted.

    Args:
        rooms: Folders of rooms to offer.
        recordings: Recordings to offer.
        recognisers: Folders of recognisers to offer.
        host: Address to bind; other than the loopback requires a token.
        port: Port to bind; 0 for any free one.
        workers: Number of worker threads; by default one per core.
        announce: Called with each line for the user.
        open_browser: Whether the page is opened.

    Raises:
        InputError: If the address is not available, or a room, recording or recogniser is not valid.
    """
    bound = _bind(host, port)
    port = bound.getsockname()[1]
    token = None if host in LOOPBACK else secrets.token_urlsafe(24)
    names = LOOPBACK if token is None else LOOPBACK | {host, socket.gethostname(), *_own_addresses()}
    shown = "localhost" if host in ("0.0.0.0", "::") else host
    address = f"http://{shown}:{port}/" + ("" if token is None else f"?token={token}")
    try:
        studio = StudioServer(Service(rooms, recordings, recognisers), workers=workers)
        config = uvicorn.Config(
            studio.app(hosts=set(names), token=token),
            log_level="warning",
            ws_max_size=1 << 20,
            timeout_graceful_shutdown=2,
            limit_concurrency=400,
        )
        announce("mmweaver studio is warming up ...")
        _Announcing(config, address, announce, open_browser).run(sockets=[bound])
    finally:
        bound.close()


def _bind(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    bound = socket.socket(family)
    bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        bound.bind((host, port))
    except (OSError, OverflowError) as error:
        bound.close()
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"cannot listen on {host} port {port}: {reason}; choose another --port or --host") from None
    return bound


def _own_addresses() -> set[str]:
    """Addresses of this machine's host name, where they can be resolved."""
    try:
        return {str(entry[4][0]) for entry in socket.getaddrinfo(socket.gethostname(), None)}
    except OSError:
        return set()
