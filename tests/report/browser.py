"""A headless Chromium that a test steers through its pipe, so that it needs neither a driver nor a port."""

import fcntl
import json
import os
import re
import select
import shutil
import subprocess
import time
from base64 import b64decode
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
needs_browser = pytest.mark.skipif(
    CHROMIUM is None, reason="no chromium on this machine, so the page is seen by no browser"
)
# The rasteriser of the processor draws the views in three dimensions, whatever the machine has.
OPTIONS = (
    "--headless", "--no-sandbox", "--hide-scrollbars", "--no-first-run", "--disable-background-networking",
    "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--remote-debugging-pipe",
)  # fmt: skip
# Seconds after which a browser that does not answer has failed.
PATIENCE = 60.0


class Page:
    """One page of a browser; events: whatever it told of itself, in order."""

    def __init__(self, to_browser: int, from_browser: int) -> None:
        """Open an empty page by the two ends of the browser's pipes."""
        self._to, self._from = to_browser, from_browser
        self._number, self._rest, self._session = 0, b"", ""
        self.events: list[dict[str, Any]] = []
        target = self.tell("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.tell("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for part in ("Page", "Runtime", "Network", "Log"):
            self.tell(f"{part}.enable")

    def tell(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Give an order of the DevTools protocol and return its answer. Raises RuntimeError for one that fails."""
        self._number += 1
        order = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            order["sessionId"] = self._session
        os.write(self._to, json.dumps(order).encode() + b"\0")
        while (said := self._next()).get("id") != self._number:
            self.events.append(said)
        if "error" in said:
            raise RuntimeError(f"{method}: {said['error']['message']}")
        answer: dict[str, Any] = said["result"]
        return answer

    def open(self, path: Path, width: int, height: int = 900, *, dark: bool = False, print_: bool = False) -> None:
        """Open a file from disk on a screen of this size [px], or as it would be printed."""
        self.screen(width, height, dark=dark, print_=print_)
        seen = len(self.events)
        self.tell("Page.navigate", url=path.as_uri())
        while not any(one["method"] == "Page.loadEventFired" for one in self.events[seen:]):
            self.events.append(self._next())

    def screen(self, width: int, height: int = 900, *, dark: bool = False, print_: bool = False) -> None:
        """Show what is open on a screen of this size [px], or as it would be printed."""
        self.tell("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        scheme = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.tell("Emulation.setEmulatedMedia", media="print" if print_ else "", features=scheme)

    def value(self, expression: str) -> Any:
        """What an expression in the page is worth, once it is settled. Raises RuntimeError where it throws."""
        found = self.tell("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in found:
            raise RuntimeError(found["exceptionDetails"]["exception"]["description"])
        return found["result"].get("value")

    def picture(self, path: Path) -> None:
        """Save the whole page as a PNG file."""
        size = self.tell("Page.getLayoutMetrics")["cssContentSize"]
        found = self.tell("Page.captureScreenshot", captureBeyondViewport=True, clip={**size, "scale": 1})
        path.write_bytes(b64decode(found["data"]))

    def sheets(self) -> int:
        """How many sheets of paper the page takes."""
        found = self.tell("Page.printToPDF", preferCSSPageSize=True, printBackground=True)
        return len(re.findall(rb"/Type\s*/Page\b", b64decode(found["data"])))

    @property
    def complaints(self) -> list[str]:
        """What stands in the console, errors that nobody caught among it."""
        told = ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")
        return [json.dumps(one["params"]) for one in self.events if one["method"] in told]

    @property
    def requests(self) -> list[str]:
        """The addresses of all that was asked for, but for what stands in the page itself."""
        sent = [one["params"]["request"]["url"] for one in self.events if one["method"] == "Network.requestWillBeSent"]
        return [url for url in sent if not url.startswith(("data:", "blob:"))]

    def _next(self) -> dict[str, Any]:
        end = time.monotonic() + PATIENCE
        while b"\0" not in self._rest:
            ready, _, _ = select.select([self._from], [], [], max(end - time.monotonic(), 0.0))
            part = os.read(self._from, 1 << 20) if ready else b""
            if not part:
                raise RuntimeError(f"the browser said nothing for {PATIENCE:g} s, or is gone")
            self._rest += part
        message, _, self._rest = self._rest.partition(b"\0")
        said: dict[str, Any] = json.loads(message)
        return said


@contextmanager
def browser_page(folder: Path) -> Iterator[Page]:
    """A page of a browser of its own, whose profile is put into a folder."""
    assert CHROMIUM is not None
    read, to_browser = os.pipe()
    from_browser, write = os.pipe()
    # The browser expects its ends at 3 and 4, so neither may be there already.
    read, write = (fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (read, write))

    def place() -> None:
        os.dup2(read, 3)
        os.dup2(write, 4)

    command = [CHROMIUM, *OPTIONS, f"--user-data-dir={folder / 'profile'}"]
    quiet = subprocess.DEVNULL
    running = subprocess.Popen(
        command, preexec_fn=place, pass_fds=(3, 4), stdin=quiet, stdout=quiet, stderr=quiet
    )  # fmt: skip
    try:
        yield Page(to_browser, from_browser)
    finally:
        running.kill()
        running.wait()
        for end in (read, write, to_browser, from_browser):
            os.close(end)
