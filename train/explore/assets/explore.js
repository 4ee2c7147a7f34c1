"use strict";

// What the controls say is one list of values, in the order of the page. Sliders and fields show it and change it; the address holds
// what of it is not as the page began. One redraw at a time, and always of the newest: a slider that is dragged asks for more of them
// than one core can make. What takes longer is asked for once the controls rest.

(() => {
  const patience = 5000; // ms: should an answer get lost, the page goes on
  const pause = 150; // ms: controls that were not moved for so long rest
  const same = (one, other) => JSON.stringify(one) === JSON.stringify(other);
  const wait = (time) => new Promise((resolve) => setTimeout(resolve, time));
  let asked = 0;
  let finish = () => {};
  let drawn = Promise.resolve();

  // Values

  const short = (number) => Number(number.toPrecision(6));
  const within = (control, number) => Math.min(Math.max(number, control.low), control.high);
  const several = (control) => Array.isArray(control.start);
  const onSlider = (control, value) => (control.logarithmic ? Math.log10(value) : value);
  const ofSlider = (control, value) => (control.logarithmic ? within(control, Number((10 ** value).toPrecision(3))) : value);
  const text = (value) => [value].flat().join(",");

  function ofText(control, words) {
    if (control.options) return control.options.includes(words) ? words : null;
    const numbers = words.split(",").map(Number);
    if (numbers.length !== [control.start].flat().length || words.trim() === "" || !numbers.every(Number.isFinite)) return null;
    const allowed = numbers.map((number) => within(control, number));
    return several(control) ? allowed.sort((one, other) => one - other) : allowed[0];
  }

  function ofAddress(about) {
    const said = new URLSearchParams(location.hash.slice(1));
    return about.map((control) => (said.has(control.name) ? ofText(control, said.get(control.name)) : null) ?? control.start);
  }

  function toAddress(about, values) {
    const said = about.flatMap((control, k) => (same(values[k], control.start) ? [] : [`${control.name}=${text(values[k])}`]));
    if (location.hash.slice(1) !== said.join("&")) history.replaceState(null, "", said.length ? `#${said.join("&")}` : location.pathname);
  }

  function entered(control, value, index, number) {
    if (number === null || !Number.isFinite(Number(number))) return value;
    const allowed = within(control, Number(number));
    return several(control) ? value.map((each, k) => (k === index ? allowed : each)).sort((one, other) => one - other) : allowed;
  }

  function moved(about, values, changes) {
    if ("reset.n_clicks" in changes) return about.map((control) => control.start);
    if ("link.data" in changes) return ofAddress(about);
    return about.map((control, k) => {
      const slid = changes[`${control.name}.value`];
      if (slid !== undefined && slid !== null) return control.options ? slid : ofSlider(control, slid);
      return control.entries.reduce((value, id, index) => {
        const number = changes[`${id}.value`];
        return number === undefined ? value : entered(control, value, index, number);
      }, values[k]);
    });
  }

  // From any control that was changed to all others: outputs are the controls, their fields, and the list of values.
  function settle(...inputs) {
    const { no_update: kept, callback_context: context } = window.dash_clientside;
    const [about, before] = inputs.slice(-2);
    const changes = Object.fromEntries((context.triggered || []).map(({ prop_id: id, value }) => [id, value]));
    const values = before ? moved(about, before, changes) : ofAddress(about);
    toAddress(about, values);
    const views = about.map((control, k) => (`${control.name}.value` in changes ? kept : control.options ? values[k] : onSlider(control, values[k])));
    const fields = about.flatMap((control, k) => control.entries.map((_, index) => short([values[k]].flat()[index])));
    name(about, values);
    return [...views, ...fields, before && same(before, values) ? kept : values];
  }

  // Names for those who do not see the page: Dash's sliders and fields have none of their own.

  let named = [];

  function name(about, values) {
    if (about) named = about.map((control, k) => ({ ...control, value: values[k] }));
    for (const control of named) {
      const each = (index) => (several(control) ? `${control.label}, patch ${index + 1}` : control.label);
      const unit = { "°": "degrees", "×": "times the blade's own" }[control.unit] ?? control.unit ?? "";
      document.querySelectorAll(`#${control.name} [role=slider]`).forEach((handle, index) => {
        handle.setAttribute("aria-label", each(index));
        handle.setAttribute("aria-valuetext", `${short([control.value].flat()[index])} ${unit}`.trim());
      });
      control.entries.forEach((id, index) => document.getElementById(id)?.setAttribute("aria-label", `${each(index)}, ${unit || "number"}`));
    }
  }

  // Pace

  async function newest(values) {
    if (!values) return window.dash_clientside.no_update;
    asked += 1;
    const mine = asked;
    analysed(true);
    await drawn;
    if (mine !== asked) return window.dash_clientside.no_update;
    drawn = new Promise((resolve) => {
      finish = resolve;
      setTimeout(resolve, patience);
    });
    return values;
  }

  async function rested(busy, values) {
    document.documentElement.dataset.busy = busy;
    if (busy !== false) return window.dash_clientside.no_update;
    finish();
    const mine = asked;
    await wait(pause);
    return mine === asked ? values : window.dash_clientside.no_update;
  }

  function analysed(analysing) {
    document.documentElement.dataset.analysing = analysing;
  }

  // Buttons

  async function copied(clicks) {
    if (!clicks) return window.dash_clientside.no_update;
    try {
      await navigator.clipboard.writeText(location.href);
      return "The link is copied. It holds what is not as the page began.";
    } catch {
      return `The link is the page's address: ${location.href}`;
    }
  }

  function saved(clicks, file) {
    if (!clicks || !file) return window.dash_clientside.no_update;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([file.text], { type: "text/plain" }));
    link.download = file.name;
    link.click();
    URL.revokeObjectURL(link.href);
    return `Saved as ${file.name}: beamenv explore --blade ${file.name}`;
  }

  window.addEventListener("hashchange", () => window.dash_clientside.set_props("link", { data: location.hash }));
  let due = false;
  new MutationObserver(() => {
    if (due) return;
    due = true;
    requestAnimationFrame(() => {
      due = false;
      name();
    });
  }).observe(document.documentElement, { childList: true, subtree: true });
  if (window.matchMedia("(max-width: 900px)").matches) {
    const folded = new MutationObserver(() => {
      const groups = document.querySelectorAll("#controls details:not(.first)");
      if (!groups.length) return;
      groups.forEach((group) => group.removeAttribute("open"));
      folded.disconnect();
    });
    folded.observe(document.documentElement, { childList: true, subtree: true });
  }

  window.dash_clientside = { ...window.dash_clientside, explore: { settle, newest, rested, analysed, copied, saved } };
})();
