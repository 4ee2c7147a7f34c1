"use strict";

// What the controls say is one list of values, in the order of the page. Sliders and fields show it and change it; the address holds
// what of it is not as the page began. One redraw at a time, and always of the newest: a slider that is dragged asks for more of them
// than one core can make. What takes longer is asked for once the controls rest.

(() => {
  const patience = 2000; // ms: should an answer get lost, so that nothing is computed though it is awaited, the page goes on
  const long = 700; // ms: what takes longer says so
  const stale = 1000; // ms: a redraw of values that are no longer wanted is stopped after so long
  const pause = 150; // ms: controls that were not moved for so long rest
  const same = (one, other) => JSON.stringify(one) === JSON.stringify(other);
  const wait = (time) => new Promise((resolve) => setTimeout(resolve, time));
  let asked = 0;
  let halted = false;
  let since = 0;
  let slowest = 0;
  let finish = () => {};
  let drawn = Promise.resolve();

  // Values

  const short = (number) => Number(number.toPrecision(6));
  const within = (control, number) => Math.min(Math.max(number, control.low), control.high);
  const several = (control) => Array.isArray(control.start);
  const plain = (control) => control.options || control.words;
  const onSlider = (control, value) => (plain(control) ? value : control.logarithmic ? Math.log10(value) : value);
  const ofSlider = (control, value) => (control.logarithmic ? within(control, Number((10 ** value).toPrecision(3))) : value);
  const text = (value) => [value].flat().join(",");

  function ofText(control, words) {
    if (control.words) return words;
    if (control.options) return control.options.includes(words) ? words : null;
    const numbers = words.split(",").map(Number);
    if (numbers.length !== [control.start].flat().length || words.trim() === "" || !numbers.every(Number.isFinite)) return null;
    const allowed = numbers.map((number) => within(control, number));
    return several(control) ? allowed.sort((one, other) => one - other) : allowed[0];
  }

  // What of the address this page cannot take, in words; the values that it can.
  function ofAddress(about, blade) {
    const said = new URLSearchParams(location.hash.slice(1));
    const other = said.get("blade");
    const starts = about.map((control) => control.start);
    if (other !== null && other !== blade) return [starts, `${ofAnother(other, blade)} Nothing of the link is applied.`];
    const names = new Set(about.map((control) => control.name));
    const lost = [...said.keys()].filter((name) => name !== "blade" && !names.has(name));
    const changed = [];
    const values = about.map((control) => {
      if (!said.has(control.name)) return control.start;
      const value = ofText(control, said.get(control.name));
      if (value === null) lost.push(control.name);
      else if (!plain(control) && text(value) !== text(said.get(control.name).split(",").map(Number))) changed.push(control.name);
      return value ?? control.start;
    });
    const sentences = [
      lost.length ? `The link's ${lost.join(", ")} cannot be set here, and ${lost.length > 1 ? "are" : "is"} left out.` : "",
      changed.length ? `The link's ${changed.join(", ")} went beyond what this page has, and stopped at its end.` : "",
      other === null && said.size ? "The link does not say which blade it is of; its values are applied to this one." : "",
    ];
    return [values, sentences.filter(Boolean).join(" ")];
  }

  function ofAnother(other, blade) {
    const name = (key) => key.replace(/-[0-9a-f]{8}$/, "");
    if (name(other) === name(blade)) return `The link is of an earlier or later version of ${name(blade)} than this page's.`;
    const option = /\.(toml|json)$/.test(name(other)) ? "--blade" : "--preset";
    return `The link is of the blade ${name(other)}, and this page shows ${name(blade)}: start it by beamenv explore ${option} ${name(other)}.`;
  }

  function toAddress(about, values, blade) {
    const said = about.flatMap((control, k) =>
      same(values[k], control.start) ? [] : [`${control.name}=${encodeURIComponent(text(values[k])).replaceAll("%2C", ",")}`],
    );
    const address = said.length ? `#${[`blade=${encodeURIComponent(blade)}`, ...said].join("&")}` : "";
    if (location.hash !== address) history.replaceState(null, "", address || location.pathname);
  }

  function entered(control, value, index, number) {
    if (number === null || !Number.isFinite(Number(number))) return value;
    const allowed = within(control, Number(number));
    return several(control) ? value.map((each, k) => (k === index ? allowed : each)).sort((one, other) => one - other) : allowed;
  }

  function moved(about, values, changes) {
    return about.map((control, k) => {
      const slid = changes[`${control.name}.value`];
      if (control.words && slid === null) return "";
      if (slid !== undefined && slid !== null) return plain(control) ? slid : ofSlider(control, slid);
      return control.entries.reduce((value, id, index) => {
        const number = changes[`${id}.value`];
        return number === undefined ? value : entered(control, value, index, number);
      }, values[k]);
    });
  }

  // From any control that was changed to all others: outputs are the controls, their fields, and the list of values.
  function settle(...inputs) {
    const { no_update: kept, callback_context: context } = window.dash_clientside;
    const [blade, about, before] = inputs.slice(-3);
    const changes = Object.fromEntries((context.triggered || []).map(({ prop_id: id, value }) => [id, value]));
    const starts = about.map((control) => control.start);
    const reset = "reset.n_clicks" in changes;
    const linked = !before || "link.data" in changes;
    const [values, notice] = reset ? [starts, ""] : linked ? ofAddress(about, blade) : [moved(about, before, changes), kept];
    toAddress(about, values, blade);
    const views = about.map((control, k) => (`${control.name}.value` in changes ? kept : onSlider(control, values[k])));
    const fields = about.flatMap((control, k) => control.entries.map((_, index) => short([values[k]].flat()[index])));
    name(about, values);
    return [...views, ...fields, before && same(before, values) && !(reset && halted) ? kept : values, notice];
  }

  // Names for those who do not see the page: Dash's sliders and fields have none of their own.

  let named = [];

  function name(about, values) {
    if (about) named = about.map((control, k) => ({ ...control, value: values[k] }));
    for (const control of named) {
      if (control.words) {
        const instead = document.getElementById(control.instead)?.closest(".control");
        if (instead) instead.hidden = control.value.trim() !== "";
      }
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
    halted = false;
    analysed(true);
    if (since && Date.now() - since > stale) end(values);
    await drawn;
    if (mine !== asked) return window.dash_clientside.no_update;
    drawn = new Promise((resolve) => {
      finish = resolve;
      const look = () => (document.documentElement.dataset.busy === "false" ? resolve() : setTimeout(look, patience));
      setTimeout(look, patience);
    });
    return values;
  }

  async function rested(busy, values) {
    document.documentElement.dataset.busy = busy;
    watch();
    if (busy !== false) return window.dash_clientside.no_update;
    finish();
    const mine = asked;
    await wait(pause);
    if (halted) analysed(false);
    const still = document.documentElement.dataset.busy === "false" && !halted;
    return mine === asked && still ? values : window.dash_clientside.no_update;
  }

  function analysed(analysing) {
    document.documentElement.dataset.analysing = analysing;
    watch();
  }

  // What takes long is said to, and can be stopped

  function watch() {
    const { busy, analysing } = document.documentElement.dataset;
    const working = busy === "true" || analysing === "true";
    if (working && !since) {
      since = Date.now();
      tick();
    }
    if (!working && since) {
      slowest = Math.max(slowest, Date.now() - since);
      since = 0;
      tick();
    }
  }

  function tick() {
    const box = document.getElementById("working");
    const passed = since ? Date.now() - since : 0;
    if (box) {
      box.hidden = passed < long;
      const before = slowest > 2000 ? `; the longest so far took ${Math.round(slowest / 1000)} s` : "";
      document.getElementById("elapsed").textContent = `Computing for ${Math.max(1, Math.round(passed / 1000))} s${before}.`;
    }
    if (since) setTimeout(tick, 250);
  }

  function end(values) {
    window.dash_clientside.set_props("stopping", { data: [...values] });
  }

  function ended(clicks, values) {
    if (!clicks || !since) return window.dash_clientside.no_update;
    halted = true;
    return values;
  }

  // Buttons

  async function copied(clicks, blade) {
    if (!clicks) return window.dash_clientside.no_update;
    const link = location.hash ? location.href : `${location.href.split("#")[0]}#blade=${encodeURIComponent(blade)}`;
    try {
      await navigator.clipboard.writeText(link);
      return "The link is copied. It holds the blade's name and what is not as the page began.";
    } catch {
      return `The link is: ${link}`;
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
      below();
    });
  }).observe(document.documentElement, { childList: true, subtree: true });
  const phone = window.matchMedia("(max-width: 900px)");
  const below = () => {
    const controls = document.getElementById("controls");
    const more = document.getElementById("more");
    if (!controls || !more) return;
    const top = Math.max(16, controls.getBoundingClientRect().top);
    controls.style.maxHeight = phone.matches ? "" : `${Math.max(240, window.innerHeight - top - 16)}px`;
    more.hidden = controls.scrollHeight - controls.scrollTop - controls.clientHeight < 24;
  };
  window.addEventListener("resize", below);
  window.addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((group) => group.setAttribute("open", "")));
  document.addEventListener("scroll", below, true);
  document.addEventListener("toggle", below, true);
  if (phone.matches) {
    const folded = new MutationObserver(() => {
      const groups = document.querySelectorAll("#controls details:not(.first)");
      if (!groups.length) return;
      groups.forEach((group) => group.removeAttribute("open"));
      folded.disconnect();
    });
    folded.observe(document.documentElement, { childList: true, subtree: true });
  }

  window.dash_clientside = { ...window.dash_clientside, explore: { settle, newest, rested, analysed, ended, copied, saved } };
})();
