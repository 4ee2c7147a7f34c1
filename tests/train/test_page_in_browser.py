"""The page in a real browser: it draws without an error, moves, sorts, and can be read in both themes and on a telephone."""

import time

import numpy as np
import pytest

webdriver = pytest.importorskip("selenium.webdriver", reason="selenium is not installed")

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def report(page_content, tmp_path_factory):
    from train.page import write_page

    path = tmp_path_factory.mktemp("page") / "report.html"
    write_page(path, page_content)
    return path


@pytest.fixture
def show(browser, report):
    """Load the page on a screen of this width under the system's colour scheme, and wait until all is drawn."""

    def load(width=1200, scheme="light"):
        screen = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
        browser.get(report.as_uri())
        wait(browser, "return document.documentElement.dataset.drawn === 'yes'")
        return browser

    return load


def wait(browser, condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not browser.execute_script(condition):
        assert time.monotonic() < end, f"not within {seconds:g} s: {condition}"
        time.sleep(0.05)


def lag_of_the_left_blade(browser):
    return np.array(browser.execute_script("return Array.from(document.getElementById('blade-left')._fullData[1].x)"))


def press(browser, key, times):
    slider = browser.find_element("id", "instant")
    for _ in range(times):
        slider.send_keys(key)


def test_the_page_draws_without_an_error_and_loads_nothing(show):
    browser = show()
    severe = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
    assert severe == []
    assert browser.execute_script("return performance.getEntriesByType('resource').map((entry) => entry.name)") == []
    assert browser.execute_script("return document.querySelectorAll('.figure .main-svg').length > 0")
    assert browser.execute_script("return document.querySelectorAll('.pair canvas').length") == 2


def test_the_slider_moves_blade_clock_and_cursor(show, page_content):
    browser = show()
    before, picture = lag_of_the_left_blade(browser), browser.find_element("id", "blade-left").screenshot_as_png
    press(browser, webdriver.Keys.ARROW_RIGHT, 15)
    wait(browser, "return document.getElementById('time-series').layout.shapes[0].x0 === 60")
    after = lag_of_the_left_blade(browser)
    tip = page_content.episode.pair[0].tip
    assert np.ptp(tip[:, 0]) > 1e-6
    assert np.abs(after[:4] - before[:4]).max() < 1e-6
    moved = after[-1] - before[-1]
    assert np.sign(moved) == np.sign(tip[120, 0] - tip[0, 0])
    assert abs(moved) > 1e-3
    assert browser.find_element("id", "clock").text == "t = 60.0 ms"
    assert browser.find_element("id", "blade-left").screenshot_as_png != picture


def test_play_goes_on_to_the_end_of_the_episode(show):
    browser = show()
    press(browser, webdriver.Keys.END, 1)
    press(browser, webdriver.Keys.ARROW_LEFT, 3)
    play = browser.find_element("id", "play")
    play.click()
    assert play.text == "Pause"
    wait(browser, "return document.getElementById('play').textContent === 'Play'")
    assert browser.find_element("id", "clock").text == "t = 100.0 ms"


def test_the_mouse_turns_both_blades(show):
    browser = show()
    camera = "return document.getElementById('blade-{}').layout.scene.camera.eye"
    before = browser.execute_script(camera.format("right"))
    left = browser.find_element("id", "blade-left")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", left)
    drag = webdriver.ActionChains(browser).move_to_element(left).click_and_hold()
    drag.move_by_offset(60, 15).move_by_offset(40, 10).release().perform()
    wait(browser, f"return document.getElementById('blade-right').layout.scene.camera.eye.x !== {before['x']}")
    wait(
        browser,
        "const eye = (side) => JSON.stringify(document.getElementById(`blade-${side}`).layout.scene.camera.eye);"
        "return eye('left') === eye('right')",
    )


def test_numbers_are_sorted_as_numbers_and_infinity_last(show):
    browser = show()
    heading = browser.find_elements("css selector", ".sortable th")[1]
    column = "return [...document.querySelectorAll('.sortable tbody tr')].map((row) => row.cells[0].textContent)"
    heading.find_element("tag name", "button").click()
    assert browser.execute_script(column) == ["LQG", "PPO", "no control", "lost"]  # 9.5, 10.25, 100: as text 10.25, 100, 9.5
    assert heading.get_attribute("aria-sort") == "ascending"
    heading.find_element("tag name", "button").click()
    assert browser.execute_script(column) == ["no control", "PPO", "LQG", "lost"]


@pytest.mark.parametrize(("scheme", "other"), [("light", "dark"), ("dark", "light")])
def test_the_theme_is_the_systems_until_the_button_is_pressed(show, scheme, other):
    from train.figures.themes import THEMES

    def colours():
        panel = browser.execute_script("return getComputedStyle(document.querySelector('section')).backgroundColor")
        title = "return getComputedStyle(document.querySelector('#poles .xtitle')).fill"
        return [tuple(int(part) for part in text[4:-1].split(",")) for text in (panel, browser.execute_script(title))]

    def expected(name):
        return [tuple(bytes.fromhex(colour[1:])) for colour in (THEMES[name].panel, THEMES[name].ink)]

    browser = show(scheme=scheme)
    assert colours() == expected(scheme)
    browser.find_element("id", "theme").click()
    end = time.monotonic() + 30.0
    while colours() != expected(other) and time.monotonic() < end:
        time.sleep(0.1)
    assert colours() == expected(other)


@pytest.mark.parametrize("width", [400, 1200])
def test_nothing_is_cut_off(show, width):
    browser = show(width)
    assert browser.execute_script("return document.documentElement.scrollWidth") <= width
    outside = """
        const cut = [];
        for (const figure of document.querySelectorAll(".figure")) {
          const frame = figure.getBoundingClientRect();
          for (const text of figure.querySelectorAll("text")) {
            const box = text.getBoundingClientRect();
            if (!box.width || !text.textContent.trim()) continue;
            const out = Math.max(frame.left - box.left, box.right - frame.right, frame.top - box.top, box.bottom - frame.bottom);
            if (out > 1) cut.push(`${figure.id}: ${text.textContent} by ${out.toFixed(0)} px`);
          }
        }
        return cut;"""
    assert browser.execute_script(outside) == []
    sizes = "return [...document.querySelectorAll('.figure text')].map((text) => parseFloat(getComputedStyle(text).fontSize))"
    assert min(browser.execute_script(sizes)) >= 10.0
