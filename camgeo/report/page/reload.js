"use strict";
// A page that is watched: it reloads where the recipe was exported anew, and shows what is wrong with one that was not.
(() => {
  const served = Number(document.currentScript.dataset.version); // a newer one may be there before the first event
  const box = document.createElement("pre");
  box.id = "fault";
  box.setAttribute("role", "alert");
  box.style.cssText =
    "position:fixed;inset:0 0 auto 0;margin:0;padding:12px 18px;max-height:60vh;overflow:auto;z-index:9;" +
    "background:#7a1405;color:#fff;white-space:pre-wrap;font:13px/1.5 monospace";
  box.hidden = true;
  document.body.append(box);
  // the server has no files: they lie in the folder that it exports to
  for (const link of document.querySelectorAll("th a")) link.removeAttribute("href");
  const events = new EventSource("/events");
  events.onmessage = (message) => {
    const event = JSON.parse(message.data);
    box.hidden = !event.fault;
    box.textContent = event.fault;
    if (event.version === served || event.fault) return;
    const { at, key, playing } = document.documentElement.dataset;
    if (at) history.replaceState(null, "", `#${key}=${at}${playing === "true" ? "&play" : ""}`);
    location.reload();
  };
})();
