"""Debian's Chromium without a window, driven through two pipes by its DevTools protocol: a page is
opened, keys are pressed, and what it says on its console or asks of the network is kept. What every
page of results has to hold in it."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

PROGRAM = shutil.which("chromium")
MOST_SECONDS = 120  # for an answer, on a machine that has other work
# As root it has no sandbox; the rest keeps it from asking for anything of its own.
FLAGS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--hide-scrollbars", "--remote-debugging-pipe"),
)


class Chromium:
    """One page. A context manager."""

    def __enter__(self) -> Chromium:
        self.profile = tempfile.TemporaryDirectory(prefix="chromium-", ignore_cleanup_errors=True)
        its_in, self.to = os.pipe()
        self.from_it, its_out = os.pipe()
        os.set_blocking(self.from_it, False)
        # The protocol is on its descriptors 3 and 4.
        words = ["sh", "-c", f'exec "$0" "$@" 3<&{its_in} 4>&{its_out}', PROGRAM, *FLAGS]
        words += [f"--user-data-dir={self.profile.name}", "about:blank"]
        self.process = subprocess.Popen(
            words,
            pass_fds=(its_in, its_out),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(its_in)
        os.close(its_out)
        self.read, self.number, self.session = b"", 0, ""
        self.events: list[dict] = []
        target = next(
            t for t in self.ask("Target.getTargets")["targetInfos"] if t["type"] == "page"
        )["targetId"]
        attached = self.ask("Target.attachToTarget", targetId=target, flatten=True)
        self.session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.ask(f"{domain}.enable")
        return self

    def __exit__(self, *_: object) -> None:
        self.process.terminate()
        self.process.wait(MOST_SECONDS)
        os.close(self.to)
        os.close(self.from_it)
        self.profile.cleanup()

    def message(self) -> dict:
        """The next one. Raises TimeoutError, or EOFError where the program has ended."""
        until = time.monotonic() + MOST_SECONDS
        while b"\0" not in self.read:
            try:
                more = os.read(self.from_it, 1 << 20)
            except BlockingIOError:
                if time.monotonic() > until:
                    raise TimeoutError("chromium does not answer") from None
                time.sleep(0.01)
                continue
            if not more:
                raise EOFError("chromium has ended")
            self.read += more
        text, _, self.read = self.read.partition(b"\0")
        return json.loads(text)

    def ask(self, method: str, **parameters: object) -> dict:
        """What it answers; events that come before are kept. Raises RuntimeError."""
        self.number += 1
        asked = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            asked["sessionId"] = self.session
        os.write(self.to, json.dumps(asked).encode() + b"\0")
        while True:
            said = self.message()
            if said.get("id") == self.number:
                if "error" in said:
                    raise RuntimeError(f"{method}: {said['error']['message']}")
                return said["result"]
            self.events.append(said)

    def open(self, page: pathlib.Path, fragment: str = "") -> None:
        """Loads a file; what was said and asked for before is forgotten."""
        # A page that is there already would not be loaded again.
        self.load("about:blank")
        self.load(page.resolve().as_uri() + fragment)

    def load(self, url: str) -> None:
        """Until it is whole."""
        self.events.clear()
        self.ask("Page.navigate", url=url)
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            self.events.append(self.message())

    def value(self, expression: str) -> object:
        """Of JavaScript in the page. Raises RuntimeError for an exception."""
        done = self.ask("Runtime.evaluate", expression=expression, returnByValue=True)
        if "exceptionDetails" in done:
            raise RuntimeError(f"{expression}: {done['exceptionDetails']}")
        return done["result"].get("value")

    def comes_true(self, expression: str) -> bool:
        """Whether it does, however slow the machine is."""
        until = time.monotonic() + MOST_SECONDS
        while not self.value(expression):
            if time.monotonic() > until:
                return False
            time.sleep(0.05)
        return True

    def press(self, key: str, code: int) -> None:
        """code: of the key, as Windows numbers them."""
        for kind in ("rawKeyDown", "keyUp"):
            self.ask(
                "Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code
            )

    def resize(self, width: int, height: int) -> None:
        self.ask(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

    def prefer(self, scheme: str) -> None:
        """`light` or `dark`, as the system would."""
        self.ask(
            "Emulation.setEmulatedMedia",
            features=[{"name": "prefers-color-scheme", "value": scheme}],
        )

    def complaints(self) -> list[str]:
        """What stood on the console since open(), and exceptions."""
        kinds = ("Log.entryAdded", "Runtime.consoleAPICalled", "Runtime.exceptionThrown")
        return [json.dumps(e["params"]) for e in self.events if e.get("method") in kinds]

    def requests(self) -> list[str]:
        """Addresses that were asked for since open(), without data of the page itself."""
        sent = [e for e in self.events if e.get("method") == "Network.requestWillBeSent"]
        urls = [event["params"]["request"]["url"] for event in sent]
        return [url for url in urls if not url.startswith("data:")]


NEEDS_BROWSER = unittest.skipUnless(PROGRAM, "chromium is not installed")
# Roles of what can be worked with or looked at: each has to have a name.
NAMED_ROLES = (
    "button",
    "slider",
    "radio",
    "tab",
    "tablist",
    "tabpanel",
    "combobox",
    "image",
    "table",
)


class PageChecks:
    """Of a unittest.TestCase."""

    def check_whole(self, browser: Chromium, page: pathlib.Path, width: int):
        """Of a page that was opened in this width: no complaint, nothing asked of a network."""
        self.assertEqual(browser.complaints(), [])
        self.assertEqual(browser.requests(), [page.resolve().as_uri()])
        across = browser.value("document.documentElement.scrollWidth")
        self.assertLessEqual(across, width)
        self.check_names(browser)

    def check_names(self, browser: Chromium):
        nodes = browser.ask("Accessibility.getFullAXTree")["nodes"]
        roles = [node["role"]["value"] for node in nodes if not node["ignored"]]
        self.assertIn("button", roles)
        for node in nodes:
            if not node["ignored"] and node["role"]["value"] in NAMED_ROLES:
                self.assertTrue(node.get("name", {}).get("value"), node)

    def check_themes(self, browser: Chromium):
        paper = "getComputedStyle(document.body).backgroundColor"
        seen = {"light": browser.value(paper)}
        browser.prefer("dark")
        # The page hears of it with its next picture.
        self.assertTrue(browser.comes_true(f"{paper} !== '{seen['light']}'"))
        seen["dark"] = browser.value(paper)
        # The button: system, light, dark, system again.
        for expected in ("light", "dark", "dark"):
            browser.value("document.getElementById('theme').click()")
            self.assertEqual(browser.value(paper), seen[expected])
        browser.prefer("light")
        self.assertTrue(browser.comes_true(f"{paper} === '{seen['light']}'"))
