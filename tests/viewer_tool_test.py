#!/usr/bin/env python3
"""The commands view and render and `compute --html`, run as a user runs them. Environment as in tool_test.py. Tests
that need a browser are skipped where there is none."""
import os
import re
import shutil
import struct
import unittest

from tool_test import BRACKET, COARSE, ToolTest, below, run

BROWSER = os.environ.get("MATSTRUCT_BROWSER") or shutil.which("chromium") or shutil.which("google-chrome")


def png_size(path):
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", data[16:24])


class Pages(ToolTest):
    def compute(self, *arguments):
        self.done(run("compute", BRACKET, "-o", self.out, "--quiet", *COARSE, *arguments))

    def test_html_is_one_file_without_links(self):
        self.compute("--html")
        page = (self.out / "bracket.html").read_text()
        self.assertNotRegex(page, r'<(script|link|img)[^>]+(src|href)="')
        self.assertRegex(page, r'"name":"bracket"')
        self.assertNotIn("/*data*/", page)

    def test_view_makes_a_page_for_every_result(self):
        self.compute()
        shutil.copy(self.out / "bracket.ma", self.out / "odd <name>.ma")
        result = run("view", self.out)
        self.done(result)
        self.assertEqual([name for name in below(self.out) if name.endswith(".html")],
                         ["bracket.html", "odd <name>.html"])
        self.assertNotIn("odd <name>", (self.out / "odd <name>.html").read_text())  # escaped

    def test_view_without_results(self):
        self.out.mkdir()
        self.refused(run("view", self.out), 1, "no results")
        self.refused(run("view", self.folder / "missing"), 1, "missing")

    def test_a_missing_viewer_is_told_before_the_work(self):
        environment = {**os.environ, "MATSTRUCT_VIEWER": str(self.folder / "nowhere.html")}
        self.refused(run("compute", BRACKET, "-o", self.out, "--html", "--quiet", env=environment), 1, "nowhere.html")
        self.assertFalse(self.out.exists())

    def test_render_refuses_bad_options(self):
        picture = self.folder / "picture.png"
        for arguments in (("--view", "inside"), ("--layers", "mesh,frobs"), ("--size", "12"), ("--theme", "pink")):
            self.refused(run("render", self.out, "-o", picture, *arguments), 2, arguments[0])
        self.refused(run("render", self.out, "-o", picture), 1)
        self.assertEqual(below(self.folder), [])

    def test_render_without_a_browser(self):
        self.compute()
        environment = {**os.environ, "MATSTRUCT_BROWSER": "/nowhere/browser"}
        picture = self.folder / "picture.png"
        self.refused(run("render", self.out, "-o", picture, "--quiet", env=environment), 1, "/nowhere/browser")
        self.assertFalse(picture.exists())

    @unittest.skipUnless(BROWSER, "no browser is here")
    def test_render_and_gallery(self):
        self.compute()
        shutil.copy(self.out / "bracket.ma", self.out / "again.ma")
        one, other, sheet = (self.folder / name for name in ("one.png", "other.png", "sheet.png"))
        self.done(run("render", self.out / "bracket.ma", "-o", one, "--size", "400x300"))
        self.done(run("render", self.out / "bracket.ma", "-o", other, "--size", "400x300", "--layers", "seams"))
        self.assertEqual(png_size(one), (400, 300))
        self.assertNotEqual(one.read_bytes(), other.read_bytes())
        self.refused(run("render", self.out, "-o", one), 2, "2 results", "--gallery")
        self.done(run("render", self.out, "-o", sheet, "--gallery", "--quiet"))
        self.assertGreater(png_size(sheet)[0], 1000)
        one_size = png_size(sheet)
        shutil.copytree(self.out, self.folder / "more")
        self.done(run("render", self.out, self.folder / "more", *[self.out / "bracket.ma"] * 3, "-o", sheet, "--gallery", "--quiet"))
        self.assertEqual((png_size(sheet)[0], png_size(sheet)[1]), (one_size[0], 2 * one_size[1]))  # 7 need a second row
        self.refused(run("render", self.out, self.folder / "more", "-o", one), 2, "--gallery")
        self.assertFalse([name for name in below(self.folder) if re.search("staging|pages", name)])


if __name__ == "__main__":
    unittest.main()
