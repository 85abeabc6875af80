"""The operator's page in use, in a real browser."""

import json
import re
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from placecell_client import Client, CompactMap
from placecell_client.classes import CLASSES
from placecell_client.maps.edit import take

from benchmarks.page.two_robots import TwoRobots
from benchmarks.synthetic_maps.road_map import road_map
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.child_process import running_service

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = [pytest.mark.slow, pytest.mark.integration]

COLORED = """() => {
  const canvas = document.querySelector(".stage canvas");
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const context = copy.getContext("2d");
  context.drawImage(canvas, 0, 0);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  let count = 0;
  for (let at = 0; at < data.length; at += 4) {
    count += Math.max(data[at], data[at + 1], data[at + 2]) > 100;
  }
  return count;
}"""
"""Counts the pixels of the picture that are brighter than its background."""


FAR_FROM_THE_MIDDLE = """canvas => {
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const context = copy.getContext("2d");
  context.drawImage(canvas, 0, 0);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  const scale = canvas.clientWidth / copy.width;
  const [found, middle] = [[], [canvas.clientWidth / 2, canvas.clientHeight / 2]];
  for (let y = 0; y < copy.height; y += 1) {
    for (let x = 0; x < copy.width; x += 1) {
      const at = 4 * (y * copy.width + x);
      const away = Math.hypot(x * scale - middle[0], y * scale - middle[1]);
      if (Math.max(data[at], data[at + 1], data[at + 2]) > 100 && away > 40 && away < 250) {
        found.push([x * scale, y * scale]);
      }
    }
  }
  return found;
}"""
"""Pixels of the picture that are drawn 40 to 250 pixels from its middle."""

NAME_IS_OVER_THE_LEGEND = """() => {
  const box = document.querySelector(".legend").getBoundingClientRect();
  const stage = document.querySelector(".stage").getBoundingClientRect();
  // The text is 12 pixels below the name's place.
  const at = [box.x + box.width / 2, box.y + box.height / 2 - 20];
  const name = document.querySelector(".labels .robot");
  name.style.transform = `translate(${at[0] - stage.x}px, ${at[1] - stage.y}px)`;
  const text = name.querySelector("b");
  text.style.pointerEvents = "auto";
  const drawn = text.getBoundingClientRect();
  const [x, y] = [drawn.x + drawn.width / 2, drawn.y + drawn.height / 2];
  const met = document.elementsFromPoint(x, y);
  if (!met.some((each) => each.closest(".legend"))) throw new Error("The name is beside it.");
  return met[0] === text;
}"""
"""Moves the name of a robot over the legend, and tells whether it is drawn above it."""

SHAPES = "/shapes?"
"""Part of the address of each request for shapes."""


def wait_until(page: "Page", condition: str, seconds: float = 30.0) -> None:
    """Wait for a condition in JavaScript.

    Playwright's own `wait_for_function` repeats it inside the page, whose policy forbids `eval`.
    """
    until = time.monotonic() + seconds
    while not page.evaluate(condition):
        assert time.monotonic() < until, condition
        page.wait_for_timeout(50)


def show(page: "Page", address: str, *maps: str) -> None:
    """Open the page and some maps."""
    page.goto(address)
    for name in maps:
        page.get_by_role("checkbox", name=f"Show map {name}").check()
        page.get_by_role("heading", name=name, exact=True).wait_for()


def segments_of(client: Client, name: str) -> int:
    return next(each.segments for each in client.maps().maps if each.name == name)


def random_map(count: int) -> CompactMap:
    manifest = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL)
    codes = np.random.default_rng(1).integers(-128, 128, (count, manifest.code_bytes), np.int8)
    return road_map(codes, manifest, "bench")


def test_maps_are_listed_with_their_robots_and_sizes(page: "Page", address: str) -> None:
    page.goto(address)
    entry = page.get_by_role("listitem").filter(has_text="yard")
    entry.get_by_text("robot A").wait_for()
    page.get_by_placeholder("Search maps and robots").fill("robot b")
    entry.wait_for(state="detached")
    page.get_by_role("button", name="hall").wait_for()


@pytest.mark.parametrize("count", [100, 1_000_000])
def test_map_of_any_size_is_drawn_and_counted(page: "Page", address: str, count: int) -> None:
    with Client(address) as client:
        client.put_map("sized", random_map(count))
    page.set_default_timeout(60_000)
    show(page, address, "sized")
    page.get_by_text(f"{count:,} segments", exact=True).wait_for()
    wait_until(page, f"({COLORED})() > 100")
    with Client(address) as client:
        client.delete_map("sized")


def test_segment_is_picked_and_its_facts_are_right(
    page: "Page", address: str, two_robots: TwoRobots
) -> None:
    show(page, address, "yard")
    wanted = int(two_robots.yard.ids[17])
    page.get_by_placeholder("Segment id").fill(str(wanted))
    page.get_by_role("button", name="Find", exact=True).click()
    card = page.get_by_role("complementary", name="Selected segment")
    card.get_by_role("heading", name=f"Segment {wanted}", exact=True).wait_for()
    x, y, z = two_robots.yard.centroids[17]
    card.get_by_text(f"{x:.2f}, {y:.2f}, {z:.2f} m").wait_for()
    card.get_by_role("button", name="Find alike segments").click()
    card.get_by_role("listitem").first.wait_for()
    page.keyboard.press("Escape")
    page.get_by_placeholder("Segment id").fill("999999")
    page.keyboard.press("Enter")
    page.get_by_role("alert").filter(has_text="no segment 999999").wait_for()


def test_segments_are_colored_by_class_and_tell_theirs(page: "Page", address: str) -> None:
    content = random_map(100)
    # Byte 0 is unknown; 1 + 31 * 3 + 27 is a vehicle with a probability of 27 / 30.
    classes = np.zeros(len(content), np.uint8)
    classes[10:20] = 1 + 31 * CLASSES.index("vehicle") + 27
    with Client(address) as client:
        client.put_map("classed", replace(content, classes=classes))
    show(page, address, "classed")
    page.get_by_label("Color by").select_option("class")
    page.get_by_role("list", name="Colors: class").get_by_text("vehicle").wait_for()
    card = page.get_by_role("complementary", name="Selected segment")
    for row, told in ((12, "vehicle (90%)"), (30, "unknown")):
        page.get_by_placeholder("Segment id").fill(str(content.ids[row]))
        page.get_by_role("button", name="Find", exact=True).click()
        card.get_by_text(told, exact=True).wait_for()
    with Client(address) as client:
        client.delete_map("classed")


def test_shapes_are_drawn_near_the_middle_and_kept(
    page: "Page", address: str, two_robots: TwoRobots
) -> None:
    asked: list[int] = []
    page.on(
        "request", lambda each: asked.append(each.url.count("id=")) if SHAPES in each.url else None
    )
    with Client(address) as client:
        classes = np.full(len(two_robots.yard), 1 + 31 * CLASSES.index("building"), np.uint8)
        client.put_map("built", replace(two_robots.yard, classes=classes))
    show(page, address, "built")
    wait_until(page, f"({COLORED})() > 100")
    switch = page.get_by_role("button", name="Shapes", exact=True)
    switch.wait_for()
    assert not asked
    page.wait_for_timeout(500)  # the last picture at rest
    before = page.evaluate(COLORED)
    switch.click()
    told = page.get_by_role("status").filter(
        has_text=re.compile("^Zoom in to see all shapes: 300 of")
    )
    told.wait_for()
    assert page.get_by_label("Color by").input_value() == "class"
    wait_until(page, f"({COLORED})() > {1.5 * before}")
    assert sum(asked) == 300
    assert max(asked) <= 50
    # A part of this view needs only shapes that are kept.
    page.get_by_label("Segments of the open maps").focus()
    page.keyboard.press("t")
    for _ in range(12):
        page.keyboard.press("+")
    page.get_by_role("status").filter(has_text=re.compile(r"^\d+ shapes?$")).wait_for()
    nearer = sum(asked)
    for _ in range(12):
        page.keyboard.press("-")
    page.keyboard.press("t")
    told.wait_for()
    assert sum(asked) < nearer + 300
    switch.click()
    told.wait_for(state="detached")
    wait_until(page, f"Math.abs(({COLORED})() - {before}) < {0.2 * before}")
    with Client(address) as client:
        client.delete_map("built")


def test_shapes_of_a_view_that_moved_on_are_canceled(page: "Page", address: str) -> None:
    failed: list[str] = []
    page.on("requestfailed", lambda each: failed.append(each.url))
    held: list[Any] = []
    page.route(f"**{SHAPES}*", lambda route: held.append(route))  # noqa: PLW0108 - Playwright needs a function
    show(page, address, "yard")
    page.get_by_role("button", name="Shapes", exact=True).click()
    page.get_by_role("status").filter(has_text="Loading shapes: 0 of").wait_for()
    until = time.monotonic() + 10
    while not held:
        assert time.monotonic() < until
        page.wait_for_timeout(50)
    page.unroute(f"**{SHAPES}*")
    page.get_by_label("Segments of the open maps").focus()
    page.keyboard.press("ArrowLeft")
    page.get_by_role("status").filter(has_text="Zoom in to see all shapes").wait_for()
    # The browser may report the canceled request after the answers to the later ones.
    until = time.monotonic() + 10
    while not failed:
        assert time.monotonic() < until
        page.wait_for_timeout(50)
    assert len(failed) == len(held) == 1
    assert SHAPES in failed[0]


def test_map_of_a_model_without_a_decoder_has_no_shapes(browser: "Browser", tmp_path: Path) -> None:
    manifest = Manifest.load(MODELS_FOLDER / "eigenvalue")
    codes = np.random.default_rng(1).integers(-128, 128, (20, manifest.code_bytes), np.int8)
    with (
        running_service(tmp_path, "--model", "eigenvalue") as address,
        browser.new_page() as page,
        Client(address) as client,
    ):
        client.put_map("plain", road_map(codes, manifest, "bench"))
        with page.expect_response(lambda each: each.url.endswith("/maps/plain") and each.ok):
            page.goto(address)
        page.get_by_text("20 segments", exact=True).wait_for()
        assert not page.get_by_role("button", name="Shapes", exact=True).count()


def test_click_on_a_point_selects_it(page: "Page", address: str) -> None:
    show(page, address, "yard")
    page.get_by_role("button", name="From above").click()
    wait_until(page, f"({COLORED})() > 100")
    canvas = page.get_by_role("img")
    found = canvas.evaluate("""canvas => {
      const copy = document.createElement("canvas");
      [copy.width, copy.height] = [canvas.width, canvas.height];
      const context = copy.getContext("2d");
      context.drawImage(canvas, 0, 0);
      const { data } = context.getImageData(0, 0, copy.width, copy.height);
      const [low, high] = [0.3 * copy.height, 0.6 * copy.height];
      for (let y = Math.floor(low); y < high; y += 1) {
        for (let x = Math.floor(copy.width / 4); x < 0.7 * copy.width; x += 1) {
          const at = 4 * (y * copy.width + x);
          if (data[at + 2] > 200 && data[at] < 120) {
            return [x * canvas.clientWidth / copy.width, y * canvas.clientHeight / copy.height];
          }
        }
      }
      return null;
    }""")
    assert found is not None
    canvas.click(position={"x": found[0], "y": found[1]})
    page.get_by_role("heading", name="Segment ").wait_for()


def test_click_on_a_shape_selects_its_segment(
    page: "Page", address: str, two_robots: TwoRobots
) -> None:
    yard, row = two_robots.yard, 17
    # The only segment is in the middle of the picture from above, and so is its own point.
    with Client(address) as client:
        client.put_map("single", take(yard, np.array([row])))
    show(page, address, "single")
    page.get_by_role("button", name="From above").click()
    page.get_by_role("button", name="Shapes", exact=True).click()
    page.get_by_role("status").filter(has_text=re.compile("^1 shape$")).wait_for()
    canvas = page.get_by_role("img")
    canvas.focus()
    page.keyboard.press("f")
    for _ in range(4):
        page.keyboard.press("+")
    wait_until(
        page, f"({FAR_FROM_THE_MIDDLE})(document.querySelector('.stage canvas')).length > 50"
    )
    page.wait_for_timeout(300)  # the last picture at rest
    found = canvas.evaluate(FAR_FROM_THE_MIDDLE)
    x, y = found[len(found) // 2]
    canvas.click(position={"x": x, "y": y})
    page.get_by_role("heading", name=f"Segment {yard.ids[row]}", exact=True).wait_for()
    with Client(address) as client:
        client.delete_map("single")


def test_name_of_a_robot_is_drawn_over_the_legend(page: "Page", address: str) -> None:
    page.set_viewport_size({"width": 390, "height": 800})
    show(page, address, "yard")
    wait_until(page, f"({COLORED})() > 100")
    page.locator(".legend").wait_for()
    with Client(address) as client:
        client.report_pose("dora", "yard", position=(1.0, 2.0, 0.0))
    page.locator(".labels").get_by_text("dora").wait_for(state="attached")
    assert page.evaluate(NAME_IS_OVER_THE_LEGEND)


def test_keyboard_moves_the_view(page: "Page", address: str) -> None:
    show(page, address, "yard")
    canvas = page.get_by_role("img")
    canvas.focus()
    scale = page.locator(".scale")
    before = scale.inner_text()
    for _ in range(6):
        page.keyboard.press("+")
    wait_until(page, f"document.querySelector('.scale').innerText !== {json.dumps(before)}")
    page.keyboard.press("t")
    assert page.get_by_role("button", name="From above").get_attribute("aria-pressed") == "true"


def test_two_maps_are_aligned_merged_and_the_merge_is_undone(page: "Page", address: str) -> None:
    show(page, address, "hall", "yard")
    page.get_by_role("button", name="Align and merge").click()
    page.get_by_role("button", name="Align", exact=True).click()
    page.get_by_text("hall fits").wait_for()
    page.get_by_role("button", name="Best").wait_for()
    page.get_by_label("Merge into map").fill("site")
    page.get_by_role("button", name="Try the merge").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_text("You can undo the merge").wait_for()
    dialog.get_by_role("button", name="Merge").click()
    page.get_by_role("checkbox", name="Show map site").wait_for()
    with Client(address) as client:
        assert {each.name for each in client.maps().maps} == {"hall", "site", "yard"}
    page.get_by_text("segments added").wait_for()
    # The merged map is shown alone: its parts would be drawn twice.
    assert not page.get_by_role("checkbox", name="Show map hall").is_checked()
    page.get_by_role("button", name="Undo the merge").click()
    page.get_by_role("checkbox", name="Show map site").wait_for(state="detached")
    page.get_by_role("checkbox", name="Show map hall", checked=True).wait_for()


def test_version_is_restored_after_a_confirmation_that_says_what_it_undoes(
    page: "Page", address: str, two_robots: TwoRobots
) -> None:
    with Client(address) as client:
        client.put_map("trail", two_robots.yard)
        client.prune_map("trail", float(two_robots.yard.frame_times[20]))
        pruned = segments_of(client, "trail")
    show(page, address, "trail")
    page.get_by_role("button", name="Versions").click()
    page.get_by_text("Version 1", exact=True).wait_for()
    page.get_by_role("button", name="Show changes").first.click()
    page.get_by_role("status").filter(has_text="replaced in version 2").wait_for()
    page.get_by_role("button", name="Restore").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_text("version 2, pruned by anyone").wait_for()
    dialog.get_by_role("button", name="Restore").click()
    page.get_by_text("Version 3", exact=True).wait_for()
    # The restore is stored whole. The page compares it with the version before.
    page.get_by_role("button", name="Show changes").first.click()
    back = len(two_robots.yard) - pruned
    told = f"{back:,} segments added or replaced in version 3, 0 removed"
    page.get_by_role("status").filter(has_text=told).wait_for()
    page.get_by_role("list", name="Colors").get_by_text("added or replaced in version 3").wait_for()
    with Client(address) as client:
        assert segments_of(client, "trail") == len(two_robots.yard) > pruned
        client.delete_map("trail")


def test_dropped_scan_is_located_in_the_map(
    page: "Page", address: str, two_robots: TwoRobots, tmp_path: Path
) -> None:
    page.goto(address)
    page.get_by_role("button", name="Locate a scan").click()
    page.get_by_label("Search in").select_option("yard")
    page.get_by_label("Choose a scan").set_input_files(two_robots.scan_file(tmp_path))
    page.get_by_text("segments.").wait_for()
    page.locator(".answer").first.wait_for()
    answer = page.locator(".answer").filter(has_text="yard").first.inner_text()
    found = re.search(r"x (-?[\d.]+) m, y (-?[\d.]+) m", answer)
    assert found, answer
    np.testing.assert_allclose(
        [float(found[1]), float(found[2])], two_robots.position[:2], atol=0.3
    )


def test_pose_of_a_robot_moves_as_it_reports(page: "Page", address: str) -> None:
    show(page, address, "yard")
    page.get_by_role("button", name="Robots").click()
    with Client(address) as client:
        # Robots of other tests may be listed, too: the service keeps them for minutes.
        entry = page.locator(".robots li").filter(has_text="carol")
        client.report_pose("carol", "yard", position=(1.0, 2.0, 0.0))
        entry.get_by_text("in yard at x 1.0, y 2.0").wait_for()
        client.report_pose("carol", "yard", position=(9.0, 2.0, 0.0))
        entry.get_by_text("in yard at x 9.0, y 2.0").wait_for()
        client.report_pose("carol", state="lost", reason="too few segments")
        entry.get_by_text("last seen in yard at x 9.0, y 2.0").wait_for()
        entry.get_by_text("too few segments", exact=True).wait_for()
        entry.get_by_text("What to do:").wait_for()
        page.get_by_text("carol is lost. too few segments").wait_for()
        page.get_by_role("button", name="Show the last pose of carol").click()
        page.locator(".labels").get_by_text("carol, last pose").wait_for()


def test_garbage_gives_a_clear_error(page: "Page", address: str, tmp_path: Path) -> None:
    file = tmp_path / "holiday.pcd"
    file.write_bytes(bytes(range(256)) * 10)
    page.goto(address)
    page.get_by_role("button", name="Locate a scan").click()
    page.get_by_label("Choose a scan").set_input_files(file)
    alert = page.get_by_role("alert").filter(has_text="holiday.pcd")
    alert.wait_for()
    # The file's bytes are not shown, and the button keeps its one line.
    assert alert.inner_text().isascii()
    box = alert.get_by_role("button", name="Close").bounding_box()
    assert box is not None
    assert box["width"] > box["height"]


def test_map_file_is_stored_under_a_chosen_name(
    page: "Page", address: str, two_robots: TwoRobots, tmp_path: Path
) -> None:
    from placecell_client import encode

    file = tmp_path / "new yard.map"
    file.write_bytes(encode(two_robots.yard))
    page.goto(address)
    page.get_by_label("Add a file").set_input_files(file)
    dialog = page.get_by_role("dialog", name="Store this map")
    assert dialog.get_by_label("Name").input_value() == "new-yard"
    dialog.get_by_label("Name").fill("hall")
    dialog.get_by_role("button", name="Store").click()
    dialog.get_by_role("alert").filter(has_text="Choose another name").wait_for()
    dialog.get_by_label("Name").fill("new-yard")
    dialog.get_by_role("button", name="Store").click()
    page.get_by_role("heading", name="new-yard", exact=True).wait_for()
    with Client(address) as client:
        client.delete_map("new-yard")


def test_names_that_hold_scripts_are_shown_as_text(page: "Page", address: str) -> None:
    evil = "<img src=x onerror=alert(1)>"
    small = random_map(100)
    with Client(address) as client:
        client.put_map("evil", replace(small, robots=(evil,), frame=evil))
    page.on("dialog", lambda dialog: pytest.fail(f"a script ran: {dialog.message}"))
    show(page, address, "evil")
    assert page.get_by_text(evil).count() >= 2
    assert page.locator("img").count() == 0
    with Client(address) as client:
        client.delete_map("evil")


def test_segment_id_that_two_maps_have_is_found_in_both(page: "Page", address: str) -> None:
    show(page, address, "hall", "yard")
    page.get_by_placeholder("Segment id").fill("17")
    page.keyboard.press("Enter")
    page.get_by_role("alert").filter(has_text="hall has this id too").wait_for()
    card = page.get_by_role("complementary", name="Selected segment")
    card.get_by_text("yard", exact=True).wait_for()
    page.keyboard.press("Enter")
    card.get_by_text("hall", exact=True).wait_for()


def test_second_way_to_align_is_a_preview_and_the_keyboard_keeps_its_place(
    page: "Page", address: str
) -> None:
    show(page, address, "hall", "yard")
    page.get_by_role("button", name="Align and merge").click()
    page.get_by_role("button", name="Align", exact=True).focus()
    page.keyboard.press("Enter")
    page.get_by_text("hall fits").wait_for()
    assert page.evaluate("document.activeElement.innerText") == "Align"
    second = page.get_by_role("button", name="Second")
    if second.count():
        second.click()
        page.get_by_text("A merge uses the best one").wait_for()
    page.get_by_role("button", name="Try the merge").focus()
    page.keyboard.press("Enter")
    page.get_by_role("dialog").wait_for()
    page.keyboard.press("Escape")
    wait_until(page, "document.activeElement.innerText === 'Try the merge'")


def test_facts_of_a_map_stand_below_its_entry(page: "Page", address: str) -> None:
    page.goto(address)
    page.get_by_role("button", name="hall", exact=True).click()
    entry = page.get_by_role("listitem").filter(has=page.get_by_role("button", name="hall"))
    entry.get_by_role("button", name="Versions").wait_for()


def test_service_panel_opens_and_closes_without_an_error(page: "Page", address: str) -> None:
    page.goto(address)
    for name in ("Service", "Robots", "Service", "Maps"):
        page.get_by_role("button", name=name, exact=True).click()
        page.wait_for_timeout(300)
    # The fixture checks that the page had no error.


def test_page_without_maps_says_so_and_shows_a_scan(
    browser: "Browser", tmp_path: Path, two_robots: TwoRobots
) -> None:
    with (
        running_service(tmp_path / "empty", "--root-path", "/fleet/robots") as address,
        browser.new_context() as context,
    ):
        # The service takes the prefix itself; it redirects to the address with a slash.
        page = context.new_page()
        page.goto(f"{address.rstrip('/')}/fleet/robots")
        page.get_by_text("There are no maps yet").wait_for()
        assert page.url.endswith("/fleet/robots/")
        page.get_by_role("button", name="Locate a scan").click()
        page.get_by_label("Choose a scan").set_input_files(two_robots.scan_file(tmp_path))
        page.get_by_text("There is no map to search").wait_for()
        assert page.get_by_text("Choose a map in the list").count() == 0
        page.get_by_placeholder("Name of the new map").fill("first")
        page.keyboard.press("Enter")
        page.get_by_text("added to first").wait_for()
        # Into a map with other segments, a scan comes at its pose there.
        with Client(address) as client:
            client.put_map("yard", two_robots.yard)
            page.get_by_label("Search in").select_option("yard")
            page.get_by_role("button", name="Add to yard").click()
            page.get_by_text("To undo this, restore the version before").wait_for()
            positions = client.get_map("yard").frame_positions
        away = np.linalg.norm(positions - two_robots.position, axis=1)
        added = ~(positions[:, None] == two_robots.yard.frame_positions[None]).all(axis=2).any(1)
        assert added.sum() == 1
        assert (away[added] < 0.3).all()
        page.get_by_placeholder("Name of the new map").fill("yard")
        page.get_by_role("alert").filter(has_text="There is a map yard already").wait_for()


@pytest.mark.parametrize("width", [1280, 390])
def test_nothing_is_cut_or_overlaps(page: "Page", address: str, width: int) -> None:
    page.set_viewport_size({"width": width, "height": 800})
    show(page, address, "yard")
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    wait_until(page, f"({COLORED})() > 100")
    boxes = [page.locator(each).bounding_box() for each in (".tools", ".compass", ".scale")]
    for index, one in enumerate(boxes):
        assert one is not None
        assert one["x"] >= 0
        assert one["x"] + one["width"] <= width
        for other in boxes[:index]:
            assert other is not None
            apart = (
                one["x"] + one["width"] <= other["x"]
                or other["x"] + other["width"] <= one["x"]
                or one["y"] + one["height"] <= other["y"]
                or other["y"] + other["height"] <= one["y"]
            )
            assert apart, (one, other)


def test_key_is_asked_for_once_and_decides_what_can_be_done(
    browser: "Browser", tmp_path: Path, two_robots: TwoRobots
) -> None:
    file = tmp_path / "keys.toml"
    keys = {}
    for name, options in {"writer": ["--write"], "reader": []}.items():
        command = [sys.executable, "-m", "cli", "keys", name, "--file", str(file), *options]
        shown = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        found = re.search(r"placecell_\S+", shown)
        assert found
        keys[name] = found[0]
    with (
        running_service(tmp_path / "service", "--keys-file", str(file)) as address,
        Client(address, key=keys["writer"]) as client,
        browser.new_context() as context,
    ):
        client.put_map("yard", two_robots.yard)
        page = context.new_page()
        page.goto(address)
        page.get_by_role("textbox", name="Key").fill("placecell_wrong")
        page.get_by_role("button", name="Sign in").click()
        page.get_by_role("alert").filter(has_text="does not know this key").wait_for()
        page.get_by_role("textbox", name="Key").fill(keys["reader"])
        page.get_by_role("button", name="Sign in").click()
        page.get_by_role("heading", name="yard", exact=True).wait_for()
        page.get_by_role("button", name="Versions").click()
        page.get_by_text("Version 1", exact=True).wait_for()
        page.get_by_text("reader (read only)").wait_for()
        page.get_by_role("button", name="Service", exact=True).click()
        page.get_by_text("You may not change, merge or upload maps").wait_for()
        page.get_by_role("button", name="Maps", exact=True).click()
        page.get_by_text("Model", exact=True).wait_for()
        for name in ("Add a file", "Prune", "Restore", "Merge"):
            assert page.get_by_role("button", name=name, exact=True).count() == 0
        page.reload()
        page.get_by_role("heading", name="yard", exact=True).wait_for()
        page.get_by_role("button", name="Sign out").click()
        page.get_by_role("textbox", name="Key").wait_for()


def test_service_that_restarts_is_found_again(
    browser: "Browser", tmp_path: Path, two_robots: TwoRobots
) -> None:
    with running_service(tmp_path) as address:
        two_robots.store(address)
        page = browser.new_page()
        page.goto(address)
        page.get_by_text("connected", exact=True).wait_for()
        page.get_by_role("checkbox", name="Show map hall").check()
        page.get_by_role("heading", name="hall", exact=True).wait_for()
    page.get_by_text("not connected", exact=True).wait_for()
    page.get_by_role("button", name="Versions").click()
    page.get_by_role("alert").filter(has_text="No connection").wait_for()
    port = address.rsplit(":", 1)[1]
    with running_service(tmp_path, "--port", port):
        page.get_by_text("connected", exact=True).wait_for()
        page.get_by_role("alert").filter(has_text="No connection").wait_for(state="detached")
        page.get_by_text("Version 1", exact=True).wait_for()
        page.get_by_role("checkbox", name="Show map yard").check()
        page.get_by_role("heading", name="yard", exact=True).wait_for()
    page.close()
