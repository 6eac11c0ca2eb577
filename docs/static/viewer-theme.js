// Viewers have the colours that the reader has chosen for the pages: light, dark or auto.
const follow = () => {
  for (const viewer of document.querySelectorAll("polhode-viewer"))
    viewer.setAttribute("theme", document.body.dataset.theme ?? "auto");
};
new MutationObserver(follow).observe(document.body, { attributeFilter: ["data-theme"] });
follow();
