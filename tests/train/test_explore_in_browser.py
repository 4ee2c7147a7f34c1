"""The explorer in a real browser: sliders redraw it without an error, and it can be read in both themes and on a telephone."""

import threading
import time
from dataclasses import replace

import pytest

pytest.importorskip("dash", reason="dash is not installed")
webdriver = pytest.importorskip("selenium.webdriver", reason="selenium is not installed")
support = pytest.importorskip("selenium.webdriver.support.ui")

from train.explore.controls import THESIS_PAGE  # noqa: E402 - it needs the package asked for above

pytestmark = pytest.mark.slow

KEY = THESIS_PAGE.key
MARKED_SPEED = "return document.querySelector('#campbell .js-plotly-plot').layout.shapes.at(-1).x0"
IDLE = (
    "document.documentElement.dataset.busy === 'false' && document.documentElement.dataset.analysing === 'false' "
    "&& document.querySelectorAll('#damping tr').length === 11 && document.querySelectorAll('#margins tr').length === 6"
)


@pytest.fixture(scope="module")
def address():
    from train.explore import serve

    server = serve(0, name="thesis")
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.port}/"
    server.shutdown()
    server.server_close()


@pytest.fixture
def show(browser, address):
    """Load the page on a screen of this width under the system's colour scheme, and wait until all is drawn."""

    def load(width=1200, scheme="light", state=""):
        screen = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
        browser.get("about:blank")  # another state in the address alone loads nothing
        browser.get(address + state)
        wait(browser, "return " + IDLE)
        return browser

    return load


def wait(browser, condition, seconds=90.0):
    support.WebDriverWait(browser, seconds, 0.05).until(lambda _: browser.execute_script(condition), condition)


def press(browser, slider, key, handle=0, times=1):
    for _ in range(times):
        browser.find_elements("css selector", f"#{slider} [role=slider]")[handle].send_keys(key)


def value_of(browser, name):
    return browser.find_element("id", name).get_property("value")


def enter(browser, name, number):
    """Write a number in place of the one that is there, and leave the field."""
    field = browser.find_element("id", name)
    field.send_keys(webdriver.Keys.CONTROL, "a")
    field.send_keys(number, webdriver.Keys.TAB)


def state_of(browser):
    return browser.execute_script("return location.hash")


def test_a_slider_redraws_every_figure_without_an_error(show, address):
    browser = show()
    names = ("campbell", "response", "shape-0", "damping", "poles", "bode", "singular", "margins")
    before = {name: browser.find_element("id", name).get_attribute("innerHTML") for name in names}
    assert browser.execute_script(MARKED_SPEED) == 200
    press(browser, "speed", webdriver.Keys.ARROW_RIGHT, times=6)
    wait(browser, f"{MARKED_SPEED} === 230 && {IDLE}")
    for name in names:
        assert browser.find_element("id", name).get_attribute("innerHTML") != before[name], name
    assert [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"] == []
    loaded = browser.execute_script("return performance.getEntriesByType('resource').map((entry) => entry.name)")
    assert [name for name in loaded if not name.startswith((address, "data:"))] == []


def test_moves_that_follow_each_other_quickly_end_at_the_last(show):
    browser = show()
    press(browser, "speed", webdriver.Keys.ARROW_RIGHT, times=20)
    wait(browser, f"{MARKED_SPEED} === 300 && {IDLE}")
    press(browser, "speed", webdriver.Keys.ARROW_LEFT, times=20)
    wait(browser, f"{MARKED_SPEED} === 200 && {IDLE}")


def test_patches_stop_where_they_would_overlap(show):
    browser = show()
    press(browser, "actuators", webdriver.Keys.PAGE_DOWN, handle=1, times=8)
    wait(browser, f"return document.getElementById('actuators-entry-1').value < 200 && {IDLE}")
    first, second, *others = (float(value_of(browser, f"actuators-entry-{k}")) for k in range(4))
    assert (first, others) == (0.0, [887.4, 1331.1])
    assert 85.0 <= second < 443.7
    assert browser.find_element("id", "message").text == ""


def test_what_makes_no_blade_is_told_and_leaves_the_sliders_usable(show):
    browser = show()
    browser.execute_script("dash_clientside.set_props('sensors', {value: [0, 20, 500, 900]})")  # the slider keeps them apart
    wait(browser, "return document.getElementById('results').hidden")
    assert "overlap" in browser.find_element("id", "message").text
    browser.execute_script("dash_clientside.set_props('sensors', {value: [0, 300, 500, 900]})")
    wait(browser, f"return !document.getElementById('results').hidden && {IDLE}")
    assert browser.find_element("id", "message").text == ""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_has_the_theme_s_ink(show, scheme):
    from train.figures.themes import THEMES

    browser = show(scheme=scheme)
    expected = "rgb({}, {}, {})".format(*bytes.fromhex(THEMES[scheme].ink[1:]))
    texts = "#results .cartesianlayer text, #results .infolayer text"
    colours = f"return [...document.querySelectorAll('{texts}')].map((text) => getComputedStyle(text).fill)"
    assert set(browser.execute_script(colours)) == {expected}
    texts = "#controls label, #controls .numbers input, #controls summary, .buttons button, .pair label, td"
    values = f"return [...document.querySelectorAll('{texts}')].map((text) => getComputedStyle(text).color)"
    assert set(browser.execute_script(values)) == {expected}


@pytest.mark.parametrize("width", [400, 1200])
def test_nothing_is_wider_than_the_screen(show, width):
    browser = show(width)
    assert browser.execute_script("return document.documentElement.scrollWidth") <= width


def test_a_number_is_entered_beside_its_slider_and_moves_it(show):
    browser = show()
    enter(browser, "speed-entry", "123.4")
    wait(browser, f"{MARKED_SPEED} === 123.4 && {IDLE}")
    handle = browser.find_element("css selector", "#speed [role=slider]")
    assert float(handle.get_attribute("aria-valuenow")) == 123.4
    assert state_of(browser) == f"#blade={KEY}&speed=123.4"
    press(browser, "speed", webdriver.Keys.HOME)
    wait(browser, f"{MARKED_SPEED} === 0 && {IDLE}")
    assert value_of(browser, "speed-entry") == "0"


@pytest.mark.parametrize(("written", "kept"), [("9999", "400"), ("-3", "0")])
def test_a_number_beyond_the_slider_becomes_its_end(show, written, kept):
    browser = show()
    enter(browser, "speed-entry", written)
    wait(browser, f"{MARKED_SPEED} === {kept} && {IDLE}")
    assert value_of(browser, "speed-entry") == kept


def test_a_weight_is_entered_as_it_is_and_its_slider_shows_its_logarithm(show):
    browser = show()
    enter(browser, "actuator_energy_weight-entry", "0.01")
    wait(browser, f"return document.getElementById('cost').textContent.includes('own Q and R') && {IDLE}")
    handle = browser.find_element("css selector", "#actuator_energy_weight [role=slider]")
    assert float(handle.get_attribute("aria-valuenow")) == -2.0
    assert handle.get_attribute("aria-valuetext") == "0.01 times the blade's own"
    handle.send_keys(webdriver.Keys.ARROW_RIGHT)
    wait(browser, f"return document.getElementById('actuator_energy_weight-entry').value === '0.0112' && {IDLE}")


def test_the_link_brings_back_the_state_and_reset_takes_it_away(show):
    state = f"#blade={KEY}&speed=150&actuators=50,443.7,887.4,1331.1&actuator_energy_weight=0.5&load=lag&sensor=2"
    browser = show(state=state)
    assert browser.execute_script(MARKED_SPEED) == 150
    assert value_of(browser, "actuators-entry-0") == "50"
    assert state_of(browser) == state
    browser.find_element("id", "reset").click()
    wait(browser, f"{MARKED_SPEED} === 200 && {IDLE}")
    assert state_of(browser) == ""
    assert value_of(browser, "actuators-entry-0") == "0"
    browser.execute_script("location.hash = '#taper=2'")
    wait(browser, f"return document.getElementById('taper-entry').value === '2' && {IDLE}")


def test_a_link_with_mistakes_says_what_of_it_is_left_out(show):
    browser = show(state="#speed=abc&pretwist_deg=1e9&actuators=1,2&load=twist&other=%3Cscript%3E&taper=")
    assert browser.execute_script(MARKED_SPEED) == 200
    assert state_of(browser) == f"#blade={KEY}&pretwist_deg=90"
    assert browser.find_element("id", "message").text == ""
    said = browser.find_element("id", "notice").text
    assert "other, speed, taper, actuators, load cannot be set here" in said
    assert "pretwist_deg went beyond" in said and "does not say which blade" in said


@pytest.mark.parametrize(
    ("other", "said"),
    [("takacs-beam-12345678", "--preset takacs-beam"), ("my.toml-12345678", "--blade my.toml"), ("thesis-12345678", "version")],
)
def test_a_link_of_another_blade_is_not_applied_and_says_so(show, other, said):
    browser = show(state=f"#blade={other}&speed=150")
    assert browser.execute_script(MARKED_SPEED) == 200
    assert state_of(browser) == ""
    assert said in browser.find_element("id", "notice").text


def test_a_twist_table_is_written_drawn_and_taken_away(show):
    browser = show()
    field = browser.find_element("id", "twist_table")
    field.send_keys("0 30, 0.5 12, 1 0", webdriver.Keys.TAB)
    wait(browser, f"return document.getElementById('along').textContent.includes('12.00°') && {IDLE}")
    assert not browser.find_element("id", "pretwist_deg").is_displayed()
    enter(browser, "twist_table", "0 30, x")
    wait(browser, "return document.getElementById('message').textContent.includes('twist_table')")
    browser.find_element("id", "reset").click()
    wait(browser, f"return document.getElementById('message').textContent === '' && {IDLE}")
    assert value_of(browser, "twist_table") == ""
    assert browser.find_element("id", "pretwist_deg").is_displayed()


def test_what_takes_long_says_so_and_is_stopped(show, monkeypatch):
    from train.explore import app

    browser = show()
    with monkeypatch.context() as patched:
        patched.setattr(app, "drawn", lambda *_: endless())
        press(browser, "speed", webdriver.Keys.ARROW_RIGHT)
        wait(browser, "return !document.getElementById('working').hidden")
        assert browser.find_element("id", "elapsed").text.startswith("Computing for")
        browser.find_element("id", "stop").click()
        wait(browser, "return document.getElementById('message').textContent.startsWith('Stopped') && " + IDLE)
    assert not browser.find_element("id", "working").is_displayed()
    press(browser, "speed", webdriver.Keys.ARROW_RIGHT)
    wait(browser, f"{MARKED_SPEED} === 210 && document.getElementById('message').textContent === '' && {IDLE}")


def endless():
    while True:
        time.sleep(0.001)


def test_the_panel_says_that_there_are_more_controls_below(show):
    browser = show(1280)
    wait(browser, "return !document.getElementById('more').hidden")
    box = browser.execute_script("return document.getElementById('more').getBoundingClientRect().bottom")
    assert box <= 900
    browser.execute_script("document.getElementById('controls').scrollTop = 1e6")
    wait(browser, "return document.getElementById('more').hidden")


def test_the_blade_is_saved_as_a_file_that_is_read_back(show, tmp_path):
    from beamenv.blade.files import load_config
    from beamenv.blade.presets import THESIS

    browser = show(state="#taper=1.5&sensor_noise_fraction=4")
    browser.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(tmp_path)})
    browser.find_element("id", "save").click()
    file = tmp_path / "blade.toml"
    support.WebDriverWait(browser, 30).until(lambda _: file.exists() and file.stat().st_size)
    expected = replace(THESIS, beam=replace(THESIS.beam, taper=1.5), sensor_noise_fraction=0.04)
    assert load_config(file) == expected
    assert "--blade blade.toml" in browser.find_element("id", "done").text


NAMELESS = """
const named = (each) => each.getAttribute('aria-label') || (each.labels && each.labels.length) || each.textContent.trim();
const all = [...document.querySelectorAll('[role=slider], input, button, summary')];
return all.filter((each) => !named(each)).map((each) => each.outerHTML);
"""


def test_all_that_takes_the_keyboard_has_a_name_of_its_own(show):
    browser = show()
    assert browser.execute_script(NAMELESS) == []
    handles = browser.find_elements("css selector", "[role=slider]")
    names = [handle.get_attribute("aria-label") for handle in handles]
    assert len(names) == len(set(names)) == 18
    assert handles[1].get_attribute("aria-valuetext") == "200 rad/s"
    assert "MFC actuators on the top wall" in browser.find_element("id", "picture").get_attribute("alt")


def test_the_page_is_worked_by_the_keyboard_alone(show):
    """Tab from the page's beginning to the rotor speed's slider, and on to a group that Enter folds."""
    browser = show()
    label = "return document.activeElement.getAttribute('aria-label') || document.activeElement.textContent"
    keyboard = webdriver.ActionChains(browser)
    seen = []
    while "rotor speed" not in seen and len(seen) < 30:
        keyboard.send_keys(webdriver.Keys.TAB).perform()
        seen.append(browser.execute_script(label))
    assert seen[:3] == ["Reset", "Copy link", "Save as blade.toml"]
    assert seen[-2:] == ["rotor speed, rad/s", "rotor speed"]
    keyboard.send_keys(webdriver.Keys.ARROW_LEFT).perform()
    wait(browser, f"{MARKED_SPEED} === 195 && {IDLE}")
    assert browser.execute_script("return getComputedStyle(document.activeElement).outlineStyle") != "none"


def test_a_telephone_shows_the_first_group_of_controls_and_opens_the_others(show):
    browser = show(400)
    groups = browser.find_elements("css selector", "#controls details")
    assert [group.get_property("open") for group in groups] == [True, False, False, False, False]
    groups[1].find_element("css selector", "summary").click()
    press(browser, "actuators", webdriver.Keys.ARROW_LEFT, handle=3)
    wait(browser, f"return document.getElementById('actuators-entry-3').value < 1331 && {IDLE}")
    assert browser.execute_script("return document.documentElement.scrollWidth") <= 400


def test_a_finger_on_a_figure_scrolls_the_page_and_one_beside_a_handle_moves_it(show):
    browser = show(400)
    browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True})
    try:
        browser.execute_script("document.getElementById('campbell').scrollIntoView()")
        before = browser.execute_script("return scrollY")
        drag(browser, [(200, 400 - 10 * k) for k in range(20)])
        wait(browser, f"return scrollY > {before} + 100")
        browser.execute_script("scrollTo(0, 0)")
        box = browser.execute_script("return document.querySelector('#speed [role=slider]').getBoundingClientRect().toJSON()")
        drag(browser, [(box["x"] + 20 + 6 * k, box["y"] + 18) for k in range(10)])
        wait(browser, f"{MARKED_SPEED} > 200 && {IDLE}")
    finally:
        browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": False})


def drag(browser, points):
    for kind, (x, y) in (("touchStart", points[0]), *(("touchMove", point) for point in points)):
        browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y}]})
    browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
