"use strict";
(() => {
  const root = document.documentElement;
  root.classList.add("js");
  addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((part) => { part.open = true; }));
  const holder = document.getElementById("payload");
  if (!holder) { root.dataset.ready = "1"; return; }
  const payload = JSON.parse(holder.textContent);
  const byId = (id) => document.getElementById(id);
  const chart = byId("chart"), trial = byId("trial"), from = byId("from"), to = byId("to");
  const dark = matchMedia("(prefers-color-scheme: dark)"), narrow = matchMedia("(max-width: 760px)");
  const config = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d"] };
  let range = null;

  const color = (name) => getComputedStyle(root).getPropertyValue("--" + name).trim();

  function traces() {
    const data = payload.trials[Number(trial.value)].data;
    return payload.traces.map(({ role, trace }, place) => ({
      ...trace, ...data[place], line: { ...trace.line, color: color(role === "measured" ? "ink" : role) },
    }));
  }

  function layout() {
    const plan = structuredClone(narrow.matches ? payload.narrow : payload.wide);
    plan.font = { ...plan.font, color: color("ink") };
    plan.hoverlabel = { bgcolor: color("raised"), font: { color: color("ink") } };
    plan.modebar = { bgcolor: "rgba(0,0,0,0)", color: color("muted"), activecolor: color("after") };
    for (const [key, axis] of Object.entries(plan)) {
      if (!/^[xy]axis/.test(key)) continue;
      Object.assign(axis, { gridcolor: color("grid"), linecolor: color("muted"), zerolinecolor: color("muted") });
      if (range && key.startsWith("x")) axis.range = range.slice();
    }
    return plan;
  }

  function show() {
    return Plotly.react(chart, traces(), layout(), config).then(() => { root.dataset.ready = "1"; });
  }

  function zoom() {
    const ends = [Number(from.value), Number(to.value)];
    if (from.value === "" || to.value === "" || !(ends[0] < ends[1])) return;
    Plotly.relayout(chart, { "xaxis.range": ends });
  }

  function whole() {
    range = null;
    from.value = to.value = "";
    show();
  }

  function saved() {
    const chosen = payload.trials[Number(trial.value)];
    const lines = ["panel,motion,t_s,value"];
    payload.traces.forEach(({ role, trace }, place) => {
      const piece = chosen.data[place], axis = "yaxis" + trace.yaxis.slice(1);
      const title = payload.wide[axis].title.text.replace("<br>", " ");
      piece.y.forEach((value, step) => {
        const t = piece.x ? piece.x[step] : piece.x0 + step * piece.dx;
        lines.push([title, role, t === null ? "" : +t.toFixed(3), value === null ? "" : value].join(","));
      });
    });
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([lines.join("\n") + "\n"], { type: "text/csv" }));
    link.download = "trial-" + (Number(trial.value) + 1) + ".csv";
    link.click();
    URL.revokeObjectURL(link.href);
  }

  document.querySelector(".controls").hidden = false;
  document.querySelector(".controls").addEventListener("submit", (event) => event.preventDefault());
  show().then(() => {
    chart.on("plotly_relayout", (change) => {
      for (const [key, value] of Object.entries(change)) {
        if (/^xaxis\d*\.autorange$/.test(key)) range = value ? null : range;
        else if (/^xaxis\d*\.range$/.test(key)) range = value.slice();
        else if (/^xaxis\d*\.range\[0\]$/.test(key)) range = [value, change[key.replace("[0]", "[1]")]];
      }
      from.value = range ? +range[0].toFixed(1) : "";
      to.value = range ? +range[1].toFixed(1) : "";
    });
  });
  trial.addEventListener("change", whole);
  from.addEventListener("change", zoom);
  to.addEventListener("change", zoom);
  byId("whole").addEventListener("click", whole);
  byId("save").addEventListener("click", saved);
  dark.addEventListener("change", show);
  narrow.addEventListener("change", show);
})();
