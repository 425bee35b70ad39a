'use strict';
// Rows keep the order of the file among equals, cells without a value come last both ways. say: tells those who
// cannot see it.
const makeSortable = (table, say) => {
  const body = table.tBodies[0];
  const rows = Array.from(body.rows);
  const buttons = Array.from(table.tHead.querySelectorAll('button'));
  // The columns from left to right: titles over two rows, and the parts of groups in between.
  const columns = [];
  const below = Array.from(table.tHead.rows[1]?.cells ?? []);
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
};
