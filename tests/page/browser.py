"""Chromium without a screen, which shows the page of a run."""

from __future__ import annotations

import json
import shutil
import time
from pathlib import Path
from typing import Any, Dict, List

import numpy as np
from numpy.typing import NDArray

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
except ImportError:
    raise SystemExit("the page's tests need Selenium: apt install python3-selenium") from None

WIDTH, HEIGHT = 1280, 800
PATIENCE_S = 60.0


def _path_of(program: str, package: str) -> str:
    found = shutil.which(program)
    if found is None:
        raise SystemExit(f"the page's tests need {program}: apt install {package}")
    return found


class Browser:
    """A window of 1280 x 800 with one page."""

    def __init__(self) -> None:
        options = Options()
        options.binary_location = _path_of("chromium", "chromium")
        for argument in ("--headless=new", "--no-sandbox", f"--window-size={WIDTH},{HEIGHT}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        service = Service(_path_of("chromedriver", "chromium-driver"))
        self.driver = webdriver.Chrome(service=service, options=options)
        metrics = {"width": WIDTH, "height": HEIGHT, "deviceScaleFactor": 1, "mobile": False}
        self.command("Emulation.setDeviceMetricsOverride", metrics)

    def close(self) -> None:
        self.driver.quit()

    def command(self, name: str, arguments: Dict[str, Any]) -> Any:
        return self.driver.execute_cdp_cmd(name, arguments)

    def run(self, script: str, *arguments: Any) -> Any:
        return self.driver.execute_script(script, *arguments)

    def wait_for(self, condition: str, *arguments: Any) -> None:
        end = time.monotonic() + PATIENCE_S
        while not self.run(f"return {condition}", *arguments):
            if time.monotonic() > end:
                raise AssertionError(f"never came true: {condition}; the console says {self.console()}")
            time.sleep(0.02)

    def drawn(self) -> None:
        """Returns when all that was asked for is on the screen."""
        done = "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()))"
        self.driver.execute_async_script(done)

    def open(self, page: Path) -> float:
        """Loads a page with all its channels; seconds until they were there."""
        begin = time.monotonic()
        self.console()
        self.requests()
        self.driver.get(page.as_uri())
        self.wait_for("document.documentElement.dataset.ready === 'yes'")
        self.drawn()
        return time.monotonic() - begin

    def console(self) -> List[str]:
        """What the page has said on the console since this was asked last."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self) -> List[str]:
        """What the page has asked for since this was asked last, itself among it."""
        messages = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        sent = [message["params"] for message in messages if message["method"] == "Network.requestWillBeSent"]
        return [str(each["request"]["url"]) for each in sent]

    def choose(self, select: str, value: str) -> None:
        """Chooses an option as a user does, and waits for the frame's channels."""
        change = "const s = document.getElementById(arguments[0]); s.value = arguments[1];"
        self.run(change + "s.dispatchEvent(new Event('change'))", select, value)
        self.settle()

    def settle(self) -> None:
        """Returns when all channels of the frame are there and drawn."""
        self.drawn()
        self.wait_for("report.shown.all.frame === report.shown.frame")
        self.wait_for("report.shown.all.size === report.shown.frame.channels.length")
        self.drawn()

    def press(self, element: str, key: str, modifiers: int = 0) -> None:
        """A key on the element that has that id; `modifiers` are Chromium's: 8 is Shift."""
        self.run("document.getElementById(arguments[0]).focus()", element)
        for kind in ("keyDown", "keyUp"):
            self.command("Input.dispatchKeyEvent", {"type": kind, "key": key, "modifiers": modifiers})
        self.drawn()

    def mouse(self, kind: str, x: float, y: float, buttons: int = 0) -> None:
        event = {"type": kind, "x": x, "y": y, "buttons": buttons, "button": "left" if buttons else "none"}
        self.command("Input.dispatchMouseEvent", event)
        self.drawn()

    def box_of(self, element: str) -> Dict[str, float]:
        """Where the element is on the screen, once it is scrolled there."""
        script = (
            "const e = document.getElementById(arguments[0]); e.scrollIntoView({block: 'center'});"
            "const b = e.getBoundingClientRect(); return {x: b.x, y: b.y, width: b.width, height: b.height}"
        )
        box: Dict[str, float] = self.run(script, element)
        self.drawn()
        return box

    def pixels_of(self, canvas: str) -> str:
        """What is drawn on a canvas, to be compared."""
        return str(self.run("return document.getElementById(arguments[0]).toDataURL()", canvas))

    def text_of(self, element: str) -> str:
        return str(self.run("return document.getElementById(arguments[0]).textContent", element))

    def probe(self) -> Dict[str, str]:
        """The table of the pixel's channels, by their names in files."""
        script = (
            "return Object.fromEntries([...document.querySelectorAll('#probe tr:not(.group)')].map("
            "row => [row.querySelector('button').title.split(':')[0], row.cells[1].textContent]))"
        )
        table: Dict[str, str] = self.run(script)
        return table

    def bits_of(self, channel: str, pixels: List[int]) -> NDArray[np.uint32]:
        """The bits of some values of a channel of the frame, as the page has unpacked them."""
        script = (
            "const values = report.shown.all.get(arguments[0]);"
            "return arguments[1].map(i => new Uint32Array(values.buffer)[i])"
        )
        return np.array(self.run(script, channel, pixels), dtype=np.uint32)
