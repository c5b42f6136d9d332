(() => {
  "use strict";
  const root = document.documentElement;
  root.classList.add("js");

  const make = (tag, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  };

  /* Numbers as people write them: a true minus, thin spaces, a unit behind, the first of a pair. */
  function numberIn(text) {
    const found = text.replaceAll("−", "-").replaceAll("\u202f", "").replaceAll("\u00a0", " ").match(/^[^\d∞-]*(-?(?:\d+(?:\.\d+)?(?:e-?\d+)?|∞))/);
    return found ? (found[1].includes("∞") ? Infinity : Number(found[1])) : NaN;
  }

  function sortable(table) {
    const body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
    if (body.rows.length < 3) return;
    heads.forEach((head, column) => {
      const button = make("button", { type: "button", textContent: head.textContent || "sort" });
      head.replaceChildren(button);
      button.addEventListener("click", () => {
        const down = head.getAttribute("aria-sort") === "ascending";
        heads.forEach((other) => other.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", down ? "descending" : "ascending");
        const rows = [...body.rows], numeric = head.classList.contains("number");
        const keys = new Map(rows.map((row) => [row, numeric ? numberIn(row.cells[column].textContent) : row.cells[column].textContent]));
        rows.sort((one, other) => {
          const [a, b] = [keys.get(one), keys.get(other)];
          if (numeric) {
            if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
            return down ? b - a : a - b;
          }
          return (down ? -1 : 1) * a.localeCompare(b, "en", { numeric: true });
        });
        body.append(...rows);
      });
    });
  }

  function filtered(table) {
    const rows = [...table.tBodies[0].rows];
    if (rows.length <= 12) return;
    const field = make("input", { type: "search" }), count = make("output", { textContent: `${rows.length} rows` });
    field.addEventListener("input", () => {
      const wanted = field.value.trim().toLowerCase();
      rows.forEach((row) => { row.hidden = !row.textContent.toLowerCase().includes(wanted); });
      const left = rows.filter((row) => !row.hidden).length;
      count.textContent = left === rows.length ? `${rows.length} rows` : `${left} of ${rows.length} rows`;
    });
    table.closest(".table").prepend(make("div", { className: "filter" }, make("label", {}, "Filter rows ", field), count));
  }

  function scrolled(region) {
    const hint = make("p", { className: "swipe", textContent: "Scroll sideways for more columns →" });
    region.before(hint);
    new ResizeObserver(() => {
      const more = region.scrollWidth > region.clientWidth + 2;
      hint.classList.toggle("shown", more);
      region.classList.toggle("more", more);
      if (more) region.tabIndex = 0; else region.removeAttribute("tabindex");
    }).observe(region);
  }

  function copied(text, holder) {
    if (navigator.clipboard && isSecureContext) return navigator.clipboard.writeText(text);
    const area = make("textarea", { value: text, readOnly: true });
    area.style.position = "fixed";
    area.style.opacity = "0";
    holder.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done ? Promise.resolve() : Promise.reject(new Error("no clipboard"));
  }

  for (const table of document.querySelectorAll(".table table")) { filtered(table); sortable(table); }
  document.querySelectorAll(".scroll").forEach(scrolled);
  for (const holder of document.querySelectorAll(".command")) {
    const text = holder.textContent.trim(), button = make("button", { type: "button", className: "copy", textContent: "Copy" });
    button.setAttribute("aria-label", `Copy the command ${text}`);
    button.addEventListener("click", () => copied(text, holder).then(() => { button.textContent = "Copied"; }, () => { button.textContent = "Select and copy"; }));
    holder.append(button);
  }
  addEventListener("beforeprint", () => document.querySelectorAll("details.printed").forEach((part) => { part.open = true; }));

  const payloads = [...document.querySelectorAll(".payload")];
  [...document.querySelectorAll(".viewer")].forEach((holder, k) => new Motions.Viewer(holder, JSON.parse(payloads[k].textContent)));
  root.dataset.ready = "1";
})();
