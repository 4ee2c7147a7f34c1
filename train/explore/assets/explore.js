"use strict";

// One redraw at a time, and always the newest: a slider that is dragged asks for more of them than one core can make.

(() => {
  const patience = 5000; // ms: should an answer get lost, the page goes on
  let asked = 0;
  let finish = () => {};
  let drawn = Promise.resolve();

  async function newest(...values) {
    asked += 1;
    const mine = asked;
    await drawn;
    if (mine !== asked) return window.dash_clientside.no_update;
    drawn = new Promise((resolve) => {
      finish = resolve;
      setTimeout(resolve, patience);
    });
    return values;
  }

  function goOn(busy) {
    document.documentElement.dataset.busy = busy;
    if (!busy) finish();
  }

  window.dash_clientside = { ...window.dash_clientside, explore: { newest, goOn } };
})();
