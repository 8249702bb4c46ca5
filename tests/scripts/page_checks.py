"""What every page of results has to hold in a browser."""

import pathlib
import unittest

from chromium import PROGRAM, Chromium

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
