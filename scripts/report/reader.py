"""A reader of report.html: what it must show is taken from report.json beside it. Called by scripts/check_report."""

import json
import sys
from pathlib import Path
from shutil import which

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select

SIZE = (1360, 900)
# Letters smaller than this on the screen are not legible [px].
LEGIBLE = 9


class Reader:
    def __init__(self, page, screenshots):
        self.page, self.screenshots = page, screenshots
        self.report = json.loads(page.with_suffix(".json").read_text(encoding="utf-8"))
        self.wrong = []
        self.driver = browser()

    def expect(self, holds, what):
        if not holds:
            self.wrong.append(what)

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def shot(self, name):
        self.driver.save_screenshot(str(self.screenshots / f"{name}.png"))

    def read(self):
        self.driver.get(self.page.as_uri())
        self.verdict()
        self.shot("report_top")
        self.filters()
        self.cases()
        self.links()
        self.pictures()
        self.width()
        self.alone()

    def verdict(self):
        """Stands at the top and says what the run has found."""
        box = self.driver.find_element(By.ID, "verdict")
        counts = self.report["counts"]
        self.expect(box.rect["y"] < 200, "the verdict is not at the top of the page")
        self.expect(self.report["verdict"].upper() in box.text.upper(), f"verdict: {box.text!r}")
        self.expect(f"{counts.get('passed', 0)} cases passed" in box.text, f"number of cases: {box.text!r}")
        colour = box.find_element(By.TAG_NAME, "strong").value_of_css_property("color")
        green = "rgba(26, 127, 55, 1)"
        self.expect((colour == green) == (self.report["verdict"] == "passed"), f"colour of the verdict: {colour}")

    def shown(self):
        return self.script(
            "return [...document.querySelectorAll('.case')].filter(c => c.offsetParent !== null).map(c => c.id)")

    def filters(self):
        """Each filter, two together, and none."""
        every = [case["name"] for case in self.report["cases"]]
        self.expect(self.shown() == every, "without a filter not every case is shown")
        words = self.driver.find_element(By.ID, "words")
        first = every[len(every) // 2].split("::")[0]
        words.send_keys(first)
        found = self.shown()
        wanted = [case["name"] for case in self.report["cases"] if first in text(case)]
        self.expect(found == wanted, f"the word {first!r} shows {len(found)} cases, expected {len(wanted)}")
        self.expect(f"{len(wanted)} of {len(every)}" in self.driver.find_element(By.ID, "shown").text,
                    "the number of cases shown is not told")
        clear(words)
        sources = {name.split("/")[0] for case in self.report["cases"] for name in case["reads"]}
        for control, value, fits in (
            [("verdicts", verdict, lambda case, v=verdict: case["verdict"] == v)
             for verdict in ("passed", "failed", "diverged", "unsupported")]
            + [("kinds", label, lambda case, k=kind: any(c["kind"] == k for c in case["checks"]))
               for kind, label in KINDS.items()
               if any(c["kind"] == kind for case in self.report["cases"] for c in case["checks"])]
            + [("sources", source, lambda case, s=source: any(n.startswith(s + "/") for n in case["reads"]))
               for source in sorted(sources)]
        ):
            select = Select(self.driver.find_element(By.ID, control))
            select.select_by_visible_text(value)
            wanted = [case["name"] for case in self.report["cases"] if fits(case)]
            self.expect(self.shown() == wanted, f"{control} = {value} shows {len(self.shown())}, not {len(wanted)}")
            select.select_by_index(0)
        self.expect(self.shown() == every, "the filters do not let go")

    def cases(self):
        """A click opens a case; it has a row for each check."""
        for case in self.report["cases"][:: max(1, len(self.report["cases"]) // 12)]:
            item = self.driver.find_element(By.ID, case["name"])
            if item.get_attribute("open") is None:
                summary = item.find_element(By.TAG_NAME, "summary")
                self.script("arguments[0].scrollIntoView({block: 'center'})", summary)
                summary.click()
            self.expect(item.get_attribute("open") is not None, f"{case['name']} does not open")
            rows = item.find_elements(By.CSS_SELECTOR, ".body table tr")
            expected = len(case["checks"]) + 1 if case["checks"] else 0
            self.expect(len(rows) == expected, f"{case['name']}: {len(rows)} rows, expected {expected}")
            self.expect(case["verdict"] in item.text, f"{case['name']}: verdict not shown")

    def links(self):
        """Every link leads somewhere on the page; one to a case opens it."""
        dead = self.script("""
            const ids = [...document.querySelectorAll('[id]')].map(e => e.id);
            const twice = ids.filter((id, i) => ids.indexOf(id) !== i);
            const dead = [...document.querySelectorAll('a')].map(a => a.getAttribute('href'))
              .filter(href => !href.startsWith('#') || !document.getElementById(decodeURIComponent(href.slice(1))));
            return [...new Set([...dead, ...twice])];""")
        self.expect(not dead, f"dead links or ids that are there twice: {dead}")
        self.script("document.getElementById('close').click()")
        links = self.driver.find_elements(By.CSS_SELECTOR, "dl a")
        if links:
            name = links[-1].get_attribute("href").split("#")[1]
            self.script("arguments[0].scrollIntoView({block: 'center'})", links[-1])
            links[-1].click()
            item = self.driver.find_element(By.ID, name)
            self.expect(item.get_attribute("open") is not None, f"the link to {name} does not open it")
            top = self.script("return arguments[0].getBoundingClientRect().top", item)
            self.expect(-5 < top < SIZE[1], f"the link to {name} does not lead there")
            self.shot("report_case")

    def pictures(self):
        """Every picture is visible, has a line, and its letters can be read and lie inside it."""
        self.script("document.getElementById('open').click()")
        bad = self.script("""
            const bad = [];
            for (const svg of document.querySelectorAll('figure svg')) {
              const box = svg.getBoundingClientRect(), name = svg.closest('.case').id;
              if (box.width < 200 || box.height < 150) bad.push(name + ': size');
              if (!svg.querySelector('polyline, line, path, circle')) bad.push(name + ': empty');
              for (const text of svg.querySelectorAll('text')) {
                const inner = text.getBoundingClientRect(), word = text.textContent.trim();
                if (!word) continue;
                if (Math.max(inner.height, inner.width) < arguments[0]) bad.push(name + ': small ' + word);
                if (inner.left < box.left - 1 || inner.right > box.right + 1 || inner.top < box.top - 1
                    || inner.bottom > box.bottom + 1) bad.push(name + ': cut off ' + word);
              }
            }
            return bad;""", LEGIBLE)
        self.expect(not bad, f"pictures: {bad[:10]}")
        count = self.script("return document.querySelectorAll('figure svg').length")
        ladders = sum(any(check["ladder"] for check in case["checks"]) for case in self.report["cases"])
        self.expect(count >= ladders > 0 or ladders == 0, f"{count} pictures for {ladders} cases with orders")
        figures = self.driver.find_elements(By.CSS_SELECTOR, ".plots")
        for index, name in ((0, "report_plots"), (-1, "report_plots_last")):
            if figures:
                self.script("arguments[0].scrollIntoView({block: 'center'})", figures[index])
                self.shot(name)
        self.script("document.getElementById('close').click()")

    def width(self):
        """No sideways scrolling of the page on a small screen either."""
        for width in (SIZE[0], 900):
            self.driver.set_window_size(width, SIZE[1])
            over = self.script("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
            self.expect(over <= 1, f"at {width} px the page is {over} px too wide")
        self.shot("report_narrow")

    def alone(self):
        """Nothing was asked of any network, and no script has complained."""
        asked = self.script("return performance.getEntriesByType('resource').map(e => e.name)")
        asked = [name for name in asked if not name.startswith("data:")]
        self.expect(not asked, f"the page asked for {asked}")
        log = [entry["message"] for entry in self.driver.get_log("browser")]
        self.expect(not log, f"the browser complains: {log}")


KINDS = {
    "closed-form": "closed form",
    "order": "order",
    "invariant": "invariant",
    "cross-code": "other program",
    "published": "published",
    "pinned": "pinned",
}


def text(case):
    """What a word is looked for in."""
    quantities = " ".join(check["quantity"] for check in case["checks"])
    return f"{case['verdict']} {case['name']} {case['source']} {quantities}".lower()


def clear(field):
    field.clear()
    field.send_keys(" \b")


def browser():
    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--host-resolver-rules=MAP * ~NOTFOUND",
                     f"--window-size={SIZE[0]},{SIZE[1]}"):
        options.add_argument(argument)
    options.binary_location = which("chromium") or which("chromium-browser") or which("google-chrome") or ""
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = which("chromedriver")
    if not options.binary_location or not driver:
        sys.exit("no chromium or chromedriver; on Debian: apt-get install chromium chromium-driver")
    return webdriver.Chrome(options=options, service=webdriver.ChromeService(driver))


def main():
    page, screenshots = map(Path, sys.argv[1:])
    reader = Reader(page, screenshots)
    try:
        reader.read()
    finally:
        reader.driver.quit()
    for line in reader.wrong:
        print(f"WRONG: {line}")
    if not reader.wrong:
        print(f"{page.name}: renders, filters and links work, pictures are legible; pictures of it in {screenshots}")
    sys.exit(1 if reader.wrong else 0)


if __name__ == "__main__":
    main()
