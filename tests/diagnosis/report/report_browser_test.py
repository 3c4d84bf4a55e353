"""Opens reports in Chromium: zoom, shared cursor, keys, glossary, phone, print, console, size and time.

    report_browser_test.py REPORT_PAGES [unittest options]

REPORT_PAGES is the program that writes the pages. Without Chromium, its driver or Selenium it says so and ends with status 77.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    print("skipped: python3-selenium is not installed")
    sys.exit(77)
CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
if not CHROMIUM or not DRIVER:
    print("skipped: chromium and chromium-driver are not installed")
    sys.exit(77)

PAGES = ("found", "unexplained", "no_gap", "large", "hostile")
PHONE_WIDTH = 360
# A4 with the browser's margins, in CSS pixels.
PAPER = {"width": 718, "height": 1047}


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        subprocess.run([PROGRAM, cls.folder.name], check=True)
        options = webdriver.ChromeOptions()
        options.binary_location = CHROMIUM
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1100,900",
                         "--force-device-scale-factor=1", "--user-data-dir=" + os.path.join(cls.folder.name, "profile")):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        try:
            from selenium.webdriver.chrome.service import Service
            cls.driver = webdriver.Chrome(service=Service(DRIVER), options=options)
        except Exception:
            cls.folder.cleanup()
            raise

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.folder.cleanup()

    def setUp(self):
        self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})

    def file(self, page):
        return os.path.join(self.folder.name, page + ".html")

    def open(self, page):
        self.driver.get("file://" + self.file(page))

    def run_script(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def plots(self):
        return self.driver.find_elements(By.CSS_SELECTOR, "svg.plot")

    def shown(self):
        """The view boxes of all curves: left edge and width."""
        return self.run_script("return [...document.querySelectorAll('svg.view')].map(v => "
                               "v.getAttribute('viewBox').split(' ').map(Number)).map(b => [b[0], b[2]])")

    def cursors(self):
        return self.run_script("return [...document.querySelectorAll('.plot')].map(p => [p.querySelector('.cursor').getAttribute('x1'), "
                               "p.parentNode.querySelector('output.time').textContent])")

    def drag(self, plot, start, end):
        """Drags over a plot; shares of its width from the middle."""
        width = plot.size["width"]
        self.run_script("arguments[0].scrollIntoView({block: 'center'})", plot)
        ActionChains(self.driver).move_to_element_with_offset(plot, int(start * width), 0).click_and_hold().move_by_offset(
            int((end - start) * width), 0).release().perform()

    def test_the_console_has_no_errors(self):
        for page in PAGES:
            with self.subTest(page):
                self.open(page)
                self.assertEqual([entry for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")], [])

    def test_hostile_names_are_text(self):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": PHONE_WIDTH, "height": 740, "deviceScaleFactor": 2, "mobile": True})
        self.open("hostile")
        self.run_script("document.querySelectorAll('details').forEach(d => d.open = true)")
        self.assertEqual(self.run_script("return typeof hostile"), "undefined")
        self.assertEqual(self.run_script("return document.images.length"), 0)
        self.assertEqual(self.run_script("return [...document.querySelectorAll('*')].filter(e => [...e.attributes].some(a => "
                                         "a.name.startsWith('on'))).map(e => e.outerHTML.slice(0, 120))"), [])
        self.assertIn("<img src=x onerror=hostile=1>", self.run_script("return document.body.textContent"))
        self.assertLessEqual(self.run_script("return document.documentElement.scrollWidth"), PHONE_WIDTH)

    def test_it_is_small_and_opens_fast(self):
        for page in PAGES:
            with self.subTest(page):
                self.assertLess(os.path.getsize(self.file(page)), 2_000_000)
                times = []
                for _ in range(3):
                    self.open(page)
                    times.append(self.run_script("const t = performance.timing; return t.loadEventEnd - t.navigationStart"))
                self.assertLess(min(times), 1000)

    def test_one_glance_says_what_to_believe(self):
        signs = set()
        for page, word in (("found", "Explained"), ("unexplained", "Cannot tell"), ("no_gap", "No gap")):
            self.open(page)
            box = self.driver.find_element(By.CSS_SELECTOR, ".verdict")
            self.assertEqual(box.find_element(By.TAG_NAME, "strong").text, word)
            self.assertLess(box.find_element(By.CSS_SELECTOR, ".headline").location["y"], 300)
            signs.add(box.find_element(By.CSS_SELECTOR, ".sign").get_attribute("innerHTML"))
        self.assertEqual(len(signs), 3)

    def test_dragging_zooms_all_plots(self):
        self.open("found")
        whole = self.shown()
        self.drag(self.plots()[0], -0.1, 0.2)
        zoomed = self.shown()
        # 0.3 of 720 pixels of which the plot takes 612.
        for before, after in zip(whole, zoomed):
            self.assertAlmostEqual(after[1] / before[1], 0.3 * 720 / 612, delta=0.01)
            self.assertEqual(after, zoomed[0])
        ticks = self.run_script("return [...document.querySelectorAll('g.ticks')].map(g => g.textContent)")
        self.assertEqual(len(set(ticks)), 1)
        self.assertNotIn("0", ticks[0][:1])
        ActionChains(self.driver).double_click(self.plots()[1]).perform()
        self.assertEqual(self.shown(), whole)
        self.drag(self.plots()[0], -0.1, 0.2)
        self.run_script("document.getElementById('whole').click()")
        self.assertEqual(self.shown(), whole)

    def test_all_plots_share_the_cursor(self):
        self.open("found")
        plot = self.plots()[0]
        self.run_script("arguments[0].scrollIntoView({block: 'center'})", plot)
        ActionChains(self.driver).move_to_element_with_offset(plot, 50, 0).perform()
        cursors = self.cursors()
        self.assertEqual(len({tuple(cursor) for cursor in cursors}), 1)
        time = float(cursors[0][1].split()[1])
        # The curves of the sample: simulated before is size (3 + sin 2 (t + 0.1)).
        import math
        figure = self.driver.find_element(By.CSS_SELECTOR, "figure[data-signal=length_0_mm]")
        read = float(figure.find_element(By.CSS_SELECTOR, "output[data-curve=before]").text)
        self.assertAlmostEqual(read, 10 * (3 + math.sin(2 * (time + 0.1))), delta=0.15)

    def test_keys_move_the_cursor_and_zoom(self):
        self.open("found")
        whole, plot = self.shown(), self.plots()[0]
        plot.send_keys(Keys.ARROW_RIGHT)
        self.assertEqual(self.cursors()[0][1], "at 5.100 s")
        self.assertEqual(len({tuple(cursor) for cursor in self.cursors()}), 1)
        plot.send_keys("+")
        self.assertAlmostEqual(self.shown()[0][1], whole[0][1] / 2, delta=1)
        left = self.shown()[0][0]
        plot.send_keys(Keys.SHIFT, Keys.ARROW_RIGHT)
        self.assertGreater(self.shown()[0][0], left)
        plot.send_keys("-")
        plot.send_keys("-")
        self.assertEqual(self.shown(), whole)
        plot.send_keys("+")
        plot.send_keys(Keys.ESCAPE)
        self.assertEqual(self.shown(), whole)

    def test_words_are_explained_in_place(self):
        self.open("found")
        button = self.driver.find_element(By.CSS_SELECTOR, ".verdict button.term")
        note = self.driver.find_element(By.ID, button.get_attribute("popovertarget"))
        self.assertFalse(note.is_displayed())
        button.send_keys(Keys.ENTER)
        self.assertTrue(note.is_displayed())
        self.assertGreater(len(note.text), 40)
        ActionChains(self.driver).send_keys(Keys.ESCAPE).perform()
        self.assertFalse(note.is_displayed())
        targets = self.run_script("return [...document.querySelectorAll('[popovertarget]')].filter(b => "
                                  "!document.getElementById(b.getAttribute('popovertarget'))).length")
        self.assertEqual(targets, 0)

    def test_a_phone_cuts_nothing(self):
        for page in PAGES[:3]:
            with self.subTest(page):
                self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                            {"width": PHONE_WIDTH, "height": 740, "deviceScaleFactor": 2, "mobile": True})
                self.open(page)
                self.run_script("document.querySelectorAll('details').forEach(d => d.open = true)")
                beyond = self.run_script(
                    "return [...document.body.querySelectorAll('*')].filter(e => !e.closest('svg.view, [popover]')).filter(e => { "
                    "const b = e.getBoundingClientRect(); return b.width && (b.right > arguments[0] + 1 || b.left < -1); })"
                    ".map(e => e.outerHTML.slice(0, 120))", PHONE_WIDTH)
                self.assertEqual(beyond, [])
                self.assertLessEqual(self.run_script("return document.documentElement.scrollWidth"), PHONE_WIDTH)
                smallest = self.run_script("return Math.min(...[...document.querySelectorAll('.plot text, .still text')].map(t => "
                                           "parseFloat(getComputedStyle(t).fontSize) * t.ownerSVGElement.getScreenCTM().a))")
                self.assertGreater(smallest, 7.5)
                # Letters of a figure are inside it and do not lie on each other.
                cut = self.run_script("""
                    const cut = [];
                    for (const figure of document.querySelectorAll('svg.plot, svg.still')) {
                      const frame = figure.getBoundingClientRect(), texts = [...figure.querySelectorAll('text')];
                      const boxes = texts.map(t => t.getBoundingClientRect());
                      boxes.forEach((a, i) => {
                        if (a.top < frame.top - 2 || a.bottom > frame.bottom + 2 || a.left < frame.left - 2 || a.right > frame.right + 2)
                          cut.push(texts[i].textContent + ' beyond the figure');
                        boxes.slice(i + 1).forEach((b, k) => {
                          const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
                          const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
                          if (wide > 1 && high > 3) cut.push(texts[i].textContent + ' on ' + texts[i + 1 + k].textContent);
                        });
                      });
                    }
                    return cut;""")
                self.assertEqual(cut, [])

    def test_print_splits_no_figure(self):
        for page in PAGES[:3]:
            with self.subTest(page):
                self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                            dict(PAPER, deviceScaleFactor=1, mobile=False))
                self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
                self.open(page)
                figures = self.run_script(
                    "return [...document.querySelectorAll('figure, .card, .bars, .robot')].map(e => [getComputedStyle(e).breakInside, "
                    "e.getBoundingClientRect().height, e.getBoundingClientRect().right, e.className])")
                for inside, height, right, name in figures:
                    self.assertEqual(inside, "avoid", name)
                    self.assertLess(height, PAPER["height"], name)
                    self.assertLessEqual(right, PAPER["width"] + 1, name)
                # What ends a figure must not be glued to what follows: a chain of glued blocks is split anywhere.
                glued = self.run_script(
                    "return [...document.querySelectorAll('figure, .card, .bars')].filter(e => { for (let c = e; c; c = c.lastElementChild) "
                    "if (getComputedStyle(c).breakAfter === 'avoid') return true; return false; }).map(e => e.className)")
                self.assertEqual(glued, [])
                notes = self.run_script("return [...document.querySelectorAll('[popover]')].every(n => n.getBoundingClientRect().height > 0)")
                self.assertTrue(notes)

    def test_curves_differ_without_colour(self):
        self.open("found")
        looks = self.run_script("return ['measured', 'before', 'after'].map(name => { const s = "
                                "getComputedStyle(document.querySelector('.plot .' + name)); return s.strokeDasharray + ' ' + s.strokeWidth; })")
        self.assertEqual(len(set(looks)), 3)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
