"""The page in a real browser: it draws without an error, moves, sorts, and can be read in both themes and on a telephone."""

import json
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
    """Load the page on a screen of this size under the system's colour scheme, and wait until its figures are drawn."""

    def load(width=1200, scheme="light", height=1400):
        screen = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
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


def pictures(browser):
    """Of both blades, as they are."""
    return browser.execute_script("return [...document.querySelectorAll('.pair canvas')].map((each) => each.toDataURL())")


def view(browser):
    """Frame, magnification and camera of the last picture."""
    wait(browser, "return document.getElementById('blade').dataset.built === 'yes'")
    browser.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
    return json.loads(browser.execute_script("return document.querySelector('.pair canvas').dataset.view"))


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


def test_the_blade_is_built_when_it_is_scrolled_to(show):
    browser = show(height=200)
    built = "return document.getElementById('blade').dataset.built ?? 'no'"
    assert browser.execute_script(built) == "no"
    browser.execute_script("document.getElementById('blade').scrollIntoView()")
    wait(browser, built.replace(" ?? 'no'", " === 'yes'"))
    assert len(set(pictures(browser))) == 2


def test_it_opens_at_the_largest_deflection_without_control(show, page_content):
    from train.page.blade import frame_times

    browser = show()
    tip = page_content.episode.without_control.tip[
        np.searchsorted(page_content.episode.time, frame_times(page_content.episode) - 1e-9)
    ]
    assert view(browser)["frame"] == np.linalg.norm(tip, axis=1).argmax()
    captions = [each.text for each in browser.find_elements("css selector", "figcaption strong")]
    assert captions == ["no control", "LQG"]


def test_the_slider_moves_blades_clock_cursor_and_what_is_read_aloud(show, page_content):
    browser = show()
    press(browser, webdriver.Keys.HOME, 1)
    view(browser)
    before = pictures(browser)
    press(browser, webdriver.Keys.ARROW_RIGHT, 15)
    wait(browser, "return document.getElementById('time-series').layout.shapes[0].x0 === 60")
    assert view(browser)["frame"] == 15
    assert all(one != other for one, other in zip(before, pictures(browser), strict=True))
    assert browser.find_element("id", "clock").text == "t = 60.0 ms"
    lag, flap = 1e6 * page_content.episode.without_control.tip[120]
    told = f"no control: Tip: lag {lag:.0f} µm, flap {flap:.0f} µm. Load: lag ".replace("-", "−")
    assert told in browser.find_element("id", "instant").get_attribute("aria-valuetext")
    assert browser.execute_script("return document.querySelector('canvas').ariaLabel").startswith(
        "The blade under no control at 60.0 ms"
    )


def test_play_goes_on_to_the_end_of_the_episode(show):
    browser = show()
    press(browser, webdriver.Keys.END, 1)
    press(browser, webdriver.Keys.ARROW_LEFT, 3)
    play = browser.find_element("id", "play")
    play.click()
    assert play.text == "Pause"
    wait(browser, "return document.getElementById('play').textContent === 'Play'")
    assert browser.find_element("id", "clock").text == "t = 100.0 ms"


def test_mouse_keys_and_buttons_turn_and_zoom_both_blades(show):
    browser = show()
    home, left = view(browser), browser.find_elements("css selector", ".pair canvas")[0]
    seen = pictures(browser)
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", left)
    drag = webdriver.ActionChains(browser).move_to_element(left).click_and_hold()
    drag.move_by_offset(60, 15).move_by_offset(40, 10).release().perform()
    turned = view(browser)
    assert turned["azimuth"] == pytest.approx(home["azimuth"] - 1.0) and turned["elevation"] > home["elevation"]
    left.send_keys("+")
    browser.find_element("css selector", "[data-move=nearer]").click()
    assert view(browser)["zoom"] == pytest.approx(1.44)
    assert all(one != other for one, other in zip(seen, pictures(browser), strict=True))
    left.send_keys("0")
    assert view(browser) == home
    assert pictures(browser) == seen


def test_two_fingers_zoom_and_move_both_blades(show):
    browser = show(400)
    home = view(browser)
    box = browser.execute_script(
        "const canvas = document.querySelectorAll('.pair canvas')[1]; canvas.scrollIntoView({block: 'center'});"
        "const {x, y, width, height} = canvas.getBoundingClientRect(); return [x + width / 2, y + height / 2, width]"
    )
    seen, (x, y, width) = pictures(browser), box

    def touch(kind, *fingers):
        points = [{"x": across, "y": down, "id": place} for place, (across, down) in enumerate(fingers)]
        browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    touch("touchStart", (x - 20, y), (x + 20, y))
    for reach in (25, 30, 35, 40):
        touch("touchMove", (x - reach + 10, y), (x + reach + 10, y))
    touch("touchEnd")
    held = view(browser)
    assert held["zoom"] == pytest.approx(2.0 * home["zoom"]) and held["azimuth"] == home["azimuth"]
    assert held["shift"] == pytest.approx([10 / width, 0.0])
    assert all(one != other for one, other in zip(seen, pictures(browser), strict=True))
    touch("touchStart", (x, y))
    touch("touchMove", (x + 30, y))
    touch("touchMove", (x + 60, y))
    touch("touchEnd")
    assert view(browser)["azimuth"] != home["azimuth"] and view(browser)["zoom"] == held["zoom"]


def test_any_two_controllers_are_chosen_and_their_curves_follow(show):
    browser = show()
    view(browser)
    before = pictures(browser)
    choose = "document.getElementById('{0}').value = '{1}'; document.getElementById('{0}').dispatchEvent(new Event('change'));"
    browser.execute_script(choose.format("left", 2))
    wait(browser, "return document.querySelector('figcaption strong').textContent === 'LQR'")
    titles = "return document.getElementById('time-series').layout.annotations.map((each) => each.text)"
    expected = ["tip displacement, lag", "tip displacement, flap", "voltages, LQG", "voltages, LQR"]
    assert browser.execute_script(titles) == expected
    names = "return [...new Set(document.getElementById('{}').data.map((each) => each.name))]"
    assert browser.execute_script(names.format("spectra")) == ["no control", "LQG", "LQR"]
    view(browser)
    after = pictures(browser)
    assert after[0] != before[0]
    browser.execute_script(choose.format("right", 0) + choose.format("left", 0))
    wait(browser, "return document.getElementById('time-series').layout.annotations.length === 2")


def test_on_paper_figures_are_light_and_as_wide_as_it(show):
    browser = show(scheme="dark", height=200)
    browser.execute_script("window.dispatchEvent(new Event('beforeprint'))")
    widths = "return [...new Set(figures.map((each) => each.layout.width))]"
    assert browser.execute_script(widths) == [690]
    assert browser.execute_script("return document.getElementById('blade').dataset.built") == "yes"
    browser.execute_script("window.dispatchEvent(new Event('afterprint'))")
    wait(browser, "return figures.every((each) => each.layout.width !== 690)")


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


def test_what_is_wider_than_the_screen_says_that_it_scrolls(show):
    told, wider = (
        f"return [...document.querySelectorAll('.scroll')].filter((each) => {condition}).map((each) => each.ariaLabel)"
        for condition in ("!each.previousElementSibling.hidden", "each.scrollWidth > each.clientWidth + 1")
    )
    narrow = show(400)
    heat_map = "document.getElementById('heat-map')"
    narrow.execute_script(f"{heat_map}.style.minWidth = '900px'")
    wait(narrow, f"return {heat_map}.closest('.scroll').classList.contains('cut')")
    assert narrow.execute_script(told) == narrow.execute_script(wider) == ["Scenarios, scrolls sideways"]
    narrow.execute_script(f"{heat_map}.closest('.scroll').scrollLeft = 10000")
    wait(narrow, f"return !{heat_map}.closest('.scroll').classList.contains('cut')")


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
