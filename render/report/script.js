'use strict';
(() => {
  const byId = (id) => document.getElementById(id);
  const say = (text) => { byId('said').textContent = text; };

  // Sorting: rows keep the order of the file among equals, cells without a value come last both ways.
  const table = byId('table');
  if (table) {
    const body = table.tBodies[0];
    const rows = Array.from(body.rows);
    const buttons = Array.from(table.tHead.querySelectorAll('button'));
    // The columns from left to right: titles over two rows, and the parts of groups in between.
    const columns = [];
    const below = Array.from(table.tHead.rows[1].cells);
    for (const cell of table.tHead.rows[0].cells) {
      if (cell.classList.contains('group')) columns.push(...below.splice(0, cell.colSpan));
      else columns.push(cell);
    }
    const collator = new Intl.Collator('en', {numeric: true});
    const sort = (title) => {
      const k = columns.indexOf(title);
      const sign = title.getAttribute('aria-sort') === 'ascending' ? -1 : 1;
      const isNumber = title.dataset.kind === 'number';
      const keyed = rows.map((row, order) => {
        const text = row.cells[k].dataset.value;
        return {row, order, isMissing: text === '', key: isNumber ? Number(text) : text};
      });
      const compare = isNumber ? (a, b) => a - b : collator.compare;
      keyed.sort((a, b) => a.isMissing - b.isMissing ||
          (a.isMissing ? 0 : sign * compare(a.key, b.key)) || a.order - b.order);
      for (const other of columns) other.setAttribute('aria-sort', 'none');
      title.setAttribute('aria-sort', sign > 0 ? 'ascending' : 'descending');
      const sorted = document.createDocumentFragment();
      for (const entry of keyed) sorted.append(entry.row);
      body.append(sorted);
      const label = title.querySelector('button').getAttribute('aria-label');
      say(`Sorted by ${label}, ${sign > 0 ? 'ascending' : 'descending'}`);
    };
    for (const button of buttons) {
      button.addEventListener('click', () => sort(button.closest('th')));
      // Browsers leave what is half covered where it is.
      button.addEventListener('focus', () => button.scrollIntoView({block: 'nearest', inline: 'nearest'}));
    }
  }

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
