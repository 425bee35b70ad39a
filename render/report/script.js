'use strict';
(() => {
  const byId = (id) => document.getElementById(id);
  const say = (text) => { byId('said').textContent = text; };

  const table = byId('table');
  if (table) makeSortable(table, say);

  // Folding.
  const sections = Array.from(document.querySelectorAll('section.material'));
  const folds = sections.map((section) => section.querySelector('details'));
  const fold = (isOpen) => () => { for (const details of folds) details.open = isOpen; };
  byId('unfold')?.addEventListener('click', fold(true));
  byId('fold')?.addEventListener('click', fold(false));

  // A link to a folded section unfolds it.
  const unfoldTarget = () => {
    const target = location.hash.length > 1 && byId(location.hash.slice(1));
    const details = target && target.closest('section.material')?.querySelector('details');
    if (details && !details.open) {
      details.open = true;
      target.scrollIntoView();
    }
  };
  addEventListener('hashchange', unfoldTarget);
  document.addEventListener('click', (event) => {
    if (event.target.closest?.('a[href^="#m"]')) setTimeout(unfoldTarget);
  });
  unfoldTarget();

  // The filter hides sections, rows and links by the material's name.
  byId('filter')?.addEventListener('input', (event) => {
    const wanted = event.target.value.trim().toLowerCase();
    const hidden = new Set();
    for (const section of sections) {
      section.hidden = !section.dataset.name.toLowerCase().includes(wanted);
      if (section.hidden) hidden.add(section.id);
    }
    for (const entry of document.querySelectorAll('[data-section]')) {
      entry.hidden = hidden.has(entry.dataset.section);
    }
    say(`${sections.length - hidden.size} of ${sections.length} materials`);
  });

  // Pictures at full size. Arrows go to the neighbours of the same material.
  const viewer = byId('viewer');
  const pane = viewer.querySelector('.pane');
  let shown = null;
  const show = (button) => {
    shown = button;
    const picture = button.querySelector('img, svg').cloneNode(true);
    pane.replaceChildren(picture);
    pane.scrollTo(0, 0);
    byId('viewer-caption').textContent = button.closest('figure').querySelector('figcaption').textContent;
    if (!viewer.open) viewer.showModal();
    pane.focus();
  };
  document.addEventListener('click', (event) => {
    const button = event.target.closest?.('.zoom');
    if (button) show(button);
  });
  byId('viewer-close').addEventListener('click', () => viewer.close());
  viewer.addEventListener('click', (event) => { if (event.target === viewer) viewer.close(); });
  viewer.addEventListener('close', () => { pane.replaceChildren(); shown?.focus(); });
  viewer.addEventListener('keydown', (event) => {
    const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (!step || pane.scrollWidth > pane.clientWidth) return;
    const all = Array.from(shown.closest('.pictures, .ladder').querySelectorAll('.zoom'));
    const next = all[all.indexOf(shown) + step];
    if (next) { show(next); event.preventDefault(); }
  });

  // Everything is printed unfolded, and folded again afterwards.
  let closed = [];
  addEventListener('beforeprint', () => {
    closed = Array.from(document.querySelectorAll('details:not([open])'));
    for (const details of closed) details.open = true;
  });
  addEventListener('afterprint', () => { for (const details of closed) details.open = false; });
})();
