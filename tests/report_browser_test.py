#!/usr/bin/env python3
"""Opens a report in headless Chromium, as a reader would.

usage: report_browser_test.py MAKE_REPORT FOLDER
MAKE_REPORT writes a report to a file; screenshots and a PDF are left in FOLDER.
"""
import base64
import pathlib
import re
import shutil
import subprocess
import sys
import time

WIDE = (1400, 1000)
NARROW = (380, 800)


def fail_for_packages(what):
    sys.exit(f"{what} is missing. On Debian: apt-get install chromium chromium-driver python3-selenium "
             "(or run scripts/setup)")


try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    fail_for_packages("python3-selenium")

failures = []


def check(is_right, message):
    if not is_right:
        failures.append(message)
        print(f"FAILED: {message}", flush=True)


def open_browser(profile):
    chromium = shutil.which("chromium")
    driver = shutil.which("chromedriver")
    if not chromium:
        fail_for_packages("chromium")
    if not driver:
        fail_for_packages("chromedriver")
    options = Options()
    options.binary_location = chromium
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     f"--user-data-dir={profile}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(driver), options=options)


def resize(browser, size):
    """The page's own size, not the window's: headless windows have a smallest width of their own."""
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                            {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False})


def screenshot(browser, file):
    shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True})
    file.write_bytes(base64.b64decode(shot["data"]))


def check_console(browser):
    for entry in browser.get_log("browser"):
        check(entry["level"] not in ("SEVERE", "WARNING"), f"console: {entry}")


def check_images(browser):
    images = browser.find_elements(By.CSS_SELECTOR, "img")
    check(len(images) > 0, "the report has images")
    # Images far below are loaded when they come near.
    for image in images:
        browser.execute_script("arguments[0].scrollIntoView()", image)
        deadline = time.monotonic() + 10.0
        is_loaded = "return arguments[0].complete && arguments[0].naturalWidth"
        while not browser.execute_script(is_loaded, image) and time.monotonic() < deadline:
            time.sleep(0.02)
        width = browser.execute_script(is_loaded, image)
        check(width, "an image did not load")
        # Not what the layout made of it.
        claimed = browser.execute_script("return arguments[0].getAttribute('width')", image)
        check(str(width) == claimed, "an image has another width than it claims")
        check(bool(image.get_attribute("alt")), "an image has no alternative text")
    browser.execute_script("scrollTo(0, 0)")


COLUMNS = """
const rows = document.querySelector('#table thead').rows, below = [...rows[1].cells], all = [];
for (const cell of rows[0].cells)
  cell.classList.contains('group') ? all.push(...below.splice(0, cell.colSpan)) : all.push(cell);
return all;
"""
CELLS = """
return [...document.querySelectorAll('#table tbody tr')].map(row => row.cells[arguments[0]].innerText);
"""


def number(text):
    """A cell's number as a reader sees it; None where there is none."""
    match = re.match(r"-?[\d.]+(e[-+]?\d+)?", text.strip())
    return float(match.group(0)) if match else None


def is_sorted(cells, is_number, is_descending):
    if not is_number:
        values = [cell.strip() for cell in cells]
    else:
        values = [number(cell) for cell in cells]
        missing = [value is None for value in values]
        if missing != sorted(missing):
            return False  # a missing value before a number
        values = [value for value in values if value is not None]
    return values == sorted(values, reverse=is_descending)


def check_sorting(browser):
    columns = browser.execute_script(COLUMNS)
    check(len(columns) == 17, f"17 columns, not {len(columns)}")
    saw_missing = False
    for k, column in enumerate(columns):
        is_number = column.get_attribute("data-kind") == "number"
        title = f"column {k} ({column.text!r})"
        button = column.find_element(By.TAG_NAME, "button")
        before = browser.execute_script(CELLS, k)
        saw_missing |= is_number and any(number(cell) is None for cell in before)
        # By mouse, then by keyboard: Enter and Space.
        for step, press in enumerate((button.click, lambda: button.send_keys(Keys.ENTER),
                                      lambda: button.send_keys(Keys.SPACE))):
            press()
            cells = browser.execute_script(CELLS, k)
            is_descending = step == 1
            wanted = "descending" if is_descending else "ascending"
            check(column.get_attribute("aria-sort") == wanted, f"{title}: aria-sort is not {wanted}")
            check(sorted(cells) == sorted(before), f"{title}: sorting changed the cells")
            check(is_sorted(cells, is_number, is_descending), f"{title}: not {wanted}: {cells}")
        others = [c for c in columns if c != column and c.get_attribute("aria-sort") != "none"]
        check(not others, f"{title}: another column says that it is sorted")
        check(browser.switch_to.active_element == button, f"{title}: the focus was lost")
        said = browser.find_element(By.ID, "said").get_attribute("textContent")
        check("ascending" in said, f"{title}: nothing was said: {said!r}")
    check(saw_missing, "the report has cells without a value")


def check_ladders(browser):
    """Each ladder has its slices side by side, in the order of its rungs, and a plot that is not cut."""
    ladders = browser.find_elements(By.CSS_SELECTOR, ".ladder")
    check(len(ladders) == 5, f"5 ladders, not {len(ladders)}")
    for ladder in ladders:
        numbers = [number.text for number in ladder.find_elements(By.CSS_SELECTOR, ".at-rung")]
        check(numbers == [str(k) for k in range(8)], f"rungs {numbers}")
        places = [(e.rect["y"], e.rect["x"]) for e in ladder.find_elements(By.CSS_SELECTOR, ".rung")]
        check(places == sorted(places), "rungs are not in the order of reading")
        check(len({x for _, x in places}) >= 3, "fewer than three slices stand side by side")
        box = ladder.rect
        for part in ladder.find_elements(By.CSS_SELECTOR, "img, svg"):
            inside = part.rect["x"] >= box["x"] - 1 and (
                part.rect["x"] + part.rect["width"] <= box["x"] + box["width"] + 1)
            check(inside and part.rect["width"] > 50, "a part of a ladder is cut or hardly seen")


def check_error_bars(browser):
    """Bars lie on their ranges, arrows included, and show in colour."""
    bars = browser.execute_script("""
        return [...document.querySelectorAll('.range .sure')].map(bar => {
          const at = bar.getBoundingClientRect(), range = bar.parentElement.getBoundingClientRect();
          return [at.left - range.left, range.right - at.right, at.width, at.height,
                  getComputedStyle(bar).color];
        });""")
    check(len(bars) == 45, f"45 error bars, not {len(bars)}")
    for left, right, width, height, colour in bars:
        check(left >= -0.5 and right >= -0.5, f"an error bar leaves its range by {min(left, right)} px")
        check(width >= 2 and height >= 3, f"an error bar is {width} px by {height} px")
        check(colour != "rgba(0, 0, 0, 0)", "an error bar has no colour")
    rows = browser.find_elements(By.XPATH, "//table[@class='parameters']//tr[contains(., 'unidentifiable')]")
    check(len(rows) == 15, f"15 unidentifiable parameters, not {len(rows)}")
    for row in rows:
        check("tied to specular" in row.text, "an unidentifiable parameter gives no reason")
        check(not row.find_elements(By.CSS_SELECTOR, ".sure"), "an unidentifiable parameter has an error bar")


def check_stability(browser):
    """Rows that are equal stay in the order of the file."""
    columns = browser.execute_script(COLUMNS)
    for title in (columns[2], columns[1]):
        button = title.find_element(By.TAG_NAME, "button")
        browser.execute_script("arguments[0].focus()", button)
        button.click()
    models = browser.execute_script(CELLS, 1)
    names = browser.execute_script(CELLS, 0)
    by_model = [name for name, model in zip(names, models) if model == models[0]]
    links = browser.execute_script(
        "return [...document.querySelectorAll('section.material h2')].map(h => h.innerText)")
    check(by_model == links, f"equal rows changed their order: {by_model}")


def check_keyboard(browser):
    """The first Tab reaches the skip link, and every control shows its focus."""
    browser.refresh()
    body = browser.find_element(By.TAG_NAME, "body")
    body.send_keys(Keys.TAB)
    active = browser.switch_to.active_element
    check(active.get_attribute("class") == "skip", "the first Tab does not reach the skip link")
    check(active.rect["x"] >= 0, "the skip link cannot be seen")
    outline = browser.execute_script("return getComputedStyle(document.activeElement).outlineStyle")
    check(outline != "none", "the focus cannot be seen")
    # The first column stays where it is while the others scroll: it must not cover what has the focus.
    for button in reversed(browser.find_elements(By.CSS_SELECTOR, "#table thead button")):
        is_visible = browser.execute_script("""
            arguments[0].focus();
            const box = arguments[0].getBoundingClientRect();
            const x = box.left + box.width / 2, y = box.top + box.height / 2;
            return document.elementFromPoint(x, y) === arguments[0];""", button)
        check(is_visible, f"{button.text!r} is covered while it has the focus")


def check_viewer(browser):
    # The plot of a ladder is alone there: arrows lead nowhere, and break nothing.
    plot = browser.find_element(By.CSS_SELECTOR, ".ladder .zoom")
    browser.execute_script("arguments[0].focus()", plot)
    plot.send_keys(Keys.ENTER)
    check(browser.find_elements(By.CSS_SELECTOR, "#viewer svg"), "Enter opens no plot")
    browser.switch_to.active_element.send_keys(Keys.ARROW_RIGHT, Keys.ESCAPE)
    zoom = browser.find_element(By.CSS_SELECTOR, ".zoom")
    browser.execute_script("arguments[0].focus()", zoom)
    zoom.send_keys(Keys.ENTER)
    check(browser.execute_script("return document.getElementById('viewer').open"), "Enter opens no picture")
    size = browser.execute_script(
        "const i = document.querySelector('#viewer img'); return [i.clientWidth, i.naturalWidth]")
    check(size[0] == size[1], f"the picture is not at its full size: {size}")
    browser.switch_to.active_element.send_keys(Keys.ESCAPE)
    deadline = time.monotonic() + 5.0
    while (browser.execute_script("return document.getElementById('viewer').open")
           and time.monotonic() < deadline):
        time.sleep(0.02)
    check(not browser.execute_script("return document.getElementById('viewer').open"), "Escape closes nothing")
    check(browser.switch_to.active_element == zoom, "the focus does not return to the picture")


def check_filter(browser):
    box = browser.find_element(By.ID, "filter")
    box.send_keys("ial-3")
    visible = [s for s in browser.find_elements(By.CSS_SELECTOR, "section.material") if s.is_displayed()]
    rows = [r for r in browser.find_elements(By.CSS_SELECTOR, "#table tbody tr") if r.is_displayed()]
    check(len(visible) == 1 and len(rows) == 3, f"the filter leaves {len(visible)} sections, {len(rows)} rows")
    box.clear()
    box.send_keys(" ", Keys.BACKSPACE)
    rows = [r for r in browser.find_elements(By.CSS_SELECTOR, "#table tbody tr") if r.is_displayed()]
    check(len(rows) == 15, "an empty filter does not show everything")


def check_width(browser, size, file):
    resize(browser, size)
    width, inner = browser.execute_script("return [document.scrollingElement.scrollWidth, innerWidth]")
    check(inner == size[0], f"the page is {inner} px wide, not {size[0]}")
    check(width <= inner, f"the page is {width} px wide in a window of {inner} px")
    cut = browser.execute_script(
        "return [...document.querySelectorAll('.fit .scroll')].filter(e => e.scrollWidth > e.clientWidth).length")
    check(cut == 0, f"{cut} lists of parameters do not fit into a window of {inner} px")
    screenshot(browser, file)


def pdf_pages(pdf):
    return len(re.findall(rb"/Type\s*/Page[^s]", pdf))


def check_print(browser, file):
    # A folded section is printed unfolded.
    browser.execute_script("document.querySelector('section.material details').open = false")
    result = browser.execute_cdp_cmd("Page.printToPDF", {"printBackground": True, "preferCSSPageSize": True})
    pdf = base64.b64decode(result["data"])
    file.write_bytes(pdf)
    check(pdf.startswith(b"%PDF"), "printing gives no PDF")
    materials = len(browser.find_elements(By.CSS_SELECTOR, "section.material"))
    check(pdf_pages(pdf) > materials, f"{pdf_pages(pdf)} pages for {materials} materials")
    is_open = browser.execute_script("return document.querySelector('section.material details').open")
    check(not is_open, "printing leaves a folded section unfolded")


def check_many(browser, make_report, folder):
    """A hundred materials: folded, and a link unfolds its section."""
    file = folder / "report_100.html"
    subprocess.run([make_report, file, "100"], check=True)
    browser.get(file.as_uri())
    rows = browser.find_elements(By.CSS_SELECTOR, "#table tbody tr")
    check(len(rows) == 300, f"300 rows, not {len(rows)}")
    opened = "return document.querySelectorAll('section.material details[open]').length"
    folded = "return [...document.querySelectorAll('section.material > details')].filter(d => d.open).length"
    check(browser.execute_script(folded) == 0, f"sections begin unfolded: {browser.execute_script(opened)}")
    browser.find_element(By.CSS_SELECTOR, "#table tbody a[href='#m5']").click()
    deadline = time.monotonic() + 5.0
    while browser.execute_script(folded) == 0 and time.monotonic() < deadline:
        time.sleep(0.02)
    is_open = browser.execute_script("return document.querySelector('#m5 > details').open")
    check(is_open, "a link does not unfold its section")
    check_console(browser)


def main():
    make_report, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    profile = folder / "profile"
    shutil.rmtree(profile, ignore_errors=True)
    report = folder / "report.html"
    subprocess.run([make_report, report], check=True)
    browser = open_browser(profile)
    try:
        resize(browser, WIDE)
        browser.get(report.as_uri())
        check(browser.title == "results – brdfit report", f"title {browser.title!r}")
        check_images(browser)
        check_ladders(browser)
        check_error_bars(browser)
        check_width(browser, WIDE, folder / "wide.png")
        check_sorting(browser)
        check_stability(browser)
        check_filter(browser)
        check_viewer(browser)
        check_keyboard(browser)
        check_width(browser, NARROW, folder / "narrow.png")
        check_ladders(browser)
        check_error_bars(browser)
        check_keyboard(browser)
        resize(browser, WIDE)
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        screenshot(browser, folder / "dark.png")
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
        check_print(browser, folder / "report.pdf")
        check_console(browser)
        check_many(browser, make_report, folder)
    finally:
        browser.quit()
        shutil.rmtree(profile, ignore_errors=True)
    sys.exit(f"{len(failures)} checks failed" if failures else 0)


if __name__ == "__main__":
    main()
