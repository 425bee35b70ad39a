(() => {
  const said = document.getElementById('said');
  for (const table of document.querySelectorAll('table.results')) {
    makeSortable(table, (text) => { said.textContent = text; });
  }

  // A point that is pointed at or reached by keyboard is named below its plot, and marked wherever it stands.
  const mark = (point) => {
    const run = point.closest('.run');
    for (const same of run.querySelectorAll('.same')) same.classList.remove('same');
    for (const same of run.querySelectorAll(`[data-point="${point.dataset.point}"]`)) same.classList.add('same');
    point.closest('figure').querySelector('.named').textContent = point.getAttribute('aria-label');
  };
  for (const plot of document.querySelectorAll('.plots svg')) {
    // Arrows go from left to right and back, whatever the order of the file.
    const points = Array.from(plot.querySelectorAll('.point'));
    const across = new Map(points.map((point) => [point, Number(point.dataset.across)]));
    points.sort((a, b) => across.get(a) - across.get(b));
    for (const point of points) {
      point.addEventListener('focus', () => mark(point));
      point.addEventListener('pointerenter', () => mark(point));
    }
    plot.addEventListener('keydown', (event) => {
      const at = points.indexOf(document.activeElement);
      const next = {ArrowLeft: at - 1, ArrowUp: at - 1, ArrowRight: at + 1, ArrowDown: at + 1, Home: 0,
        End: points.length - 1}[event.key];
      if (next === undefined || !points[next]) return;
      for (const point of points) point.tabIndex = point === points[next] ? 0 : -1;
      points[next].focus();
      event.preventDefault();
    });
  }
})();
