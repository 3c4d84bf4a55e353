#include "report_page.h"

namespace musclesim {

std::string reportScript() {
  return R"js(<script>
(() => {
  const svgName = 'http://www.w3.org/2000/svg';
  const element = (name, attributes, parent) => {
    const made = document.createElementNS(svgName, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return parent.appendChild(made);
  };
  const plots = [...document.querySelectorAll('svg.plot')].map(svg => {
    const views = [...svg.querySelectorAll('svg.view')], size = name => +views[0].getAttribute(name);
    const last = views[views.length - 1], top = size('y');
    return {svg, views, x: size('x'), width: size('width'), top,
            height: +last.getAttribute('y') + +last.getAttribute('height') - top,
            start: +views[0].dataset.start, end: +views[0].dataset.end, ticks: svg.querySelector('g.ticks'),
            outputs: [...svg.parentNode.querySelectorAll('output[data-curve]')], clock: svg.parentNode.querySelector('output.time'),
            line: element('line', {class: 'cursor', visibility: 'hidden'}, svg),
            chosen: element('rect', {class: 'chosen', visibility: 'hidden'}, svg)};
  });
  if (!plots.length) return;
  const whole = [Math.min(...plots.map(p => p.start)), Math.max(...plots.map(p => p.end))];
  let shown = whole, cursor = null;
  const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
  const niceStep = (span, count) => {
    const raw = span / count, power = 10 ** Math.floor(Math.log10(raw));
    return [1, 2, 5, 10].map(f => f * power).find(step => step >= raw * 0.999);
  };
  const pixel = (p, time) => p.x + (time - shown[0]) / (shown[1] - shown[0]) * p.width;

  // The points of a curve, read from its path once: relative points in tenths of a pixel.
  const pointsOf = path => path.points ??= path.getAttribute('d').split('M').slice(1).map(piece => {
    const numbers = piece.match(/-?\d+/g).map(Number), points = [];
    let x = 0, y = 0;
    for (let i = 0; i + 1 < numbers.length; i += 2) points.push([x += numbers[i], y += numbers[i + 1]]);
    return points;
  });
  const valueAt = (p, look, time) => {
    const view = p.views[0], path = view.querySelector('path.' + look);
    if (!path) return NaN;
    const x = (time - p.start) / (p.end - p.start) * p.width * 10, height = +view.getAttribute('height') * 10;
    for (const points of pointsOf(path)) {
      const next = points.findIndex(point => point[0] >= x);
      if (next < 0 || points[0][0] > x + 10) continue;
      const b = points[next], a = points[Math.max(0, next - 1)];
      const y = b[0] > a[0] ? a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]) : b[1];
      return +view.dataset.high - y / height * (view.dataset.high - view.dataset.low);
    }
    return NaN;
  };

  const drawCursor = () => plots.forEach(p => {
    const visible = cursor !== null && cursor >= shown[0] && cursor <= shown[1];
    p.line.setAttribute('visibility', visible ? 'visible' : 'hidden');
    p.clock.textContent = visible ? `at ${cursor.toFixed(3)} s` : '';
    for (const output of p.outputs) {
      const value = visible ? valueAt(p, output.dataset.curve, cursor) : NaN;
      output.textContent = Number.isFinite(value) ? value.toPrecision(4) : '';
    }
    if (!visible) return;
    const x = pixel(p, cursor);
    for (const [key, value] of Object.entries({x1: x, x2: x, y1: p.top, y2: p.top + p.height})) p.line.setAttribute(key, value);
  });
  const drawTicks = p => {
    const narrow = p.svg.getBoundingClientRect().width < 500;
    const step = niceStep(shown[1] - shown[0], narrow ? 5 : 8), digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    p.ticks.replaceChildren();
    for (let t = Math.ceil(shown[0] / step - 1e-9) * step; t <= shown[1] + 1e-9; t += step)
      element('text', {x: pixel(p, t), y: p.ticks.dataset.y}, p.ticks).textContent = t.toFixed(digits);
  };
  const show = ([from, to]) => {
    const least = (whole[1] - whole[0]) / 500, span = clamp(to - from, least, whole[1] - whole[0]);
    const start = clamp(from, whole[0], whole[1] - span);
    shown = [start, start + span];
    plots.forEach(p => {
      const perSecond = 10 * p.width / (p.end - p.start);
      p.views.forEach(view => view.setAttribute('viewBox',
          `${(shown[0] - p.start) * perSecond} 0 ${span * perSecond} ${10 * view.getAttribute('height')}`));
      drawTicks(p);
    });
    drawCursor();
  };
  const zoom = (factor, at) => show([at - (at - shown[0]) * factor, at + (shown[1] - at) * factor]);
  const pan = share => { const by = share * (shown[1] - shown[0]); show([shown[0] + by, shown[1] + by]); };
  const moveCursor = share => {
    const span = shown[1] - shown[0];
    cursor = clamp((cursor ?? shown[0] + span / 2) + share * span, shown[0], shown[1]);
    drawCursor();
  };
  const keys = {
    ArrowLeft: event => event.shiftKey ? pan(-0.2) : moveCursor(-0.01),
    ArrowRight: event => event.shiftKey ? pan(0.2) : moveCursor(0.01),
    '+': () => zoom(0.5, cursor ?? (shown[0] + shown[1]) / 2),
    '-': () => zoom(2, cursor ?? (shown[0] + shown[1]) / 2),
    0: () => show(whole), Home: () => show(whole),
    Escape: () => { cursor = null; show(whole); },
  };
  keys['='] = keys['+'];

  plots.forEach(p => {
    let from = null;
    const timeAt = event => {
      const box = p.svg.getBoundingClientRect(), x = (event.clientX - box.left) * p.svg.viewBox.baseVal.width / box.width;
      return shown[0] + clamp((x - p.x) / p.width, 0, 1) * (shown[1] - shown[0]);
    };
    p.svg.addEventListener('pointerdown', event => { if (event.button === 0) from = timeAt(event); });
    p.svg.addEventListener('pointermove', event => {
      cursor = timeAt(event);
      drawCursor();
      if (from === null) return;
      const a = pixel(p, Math.min(from, cursor)), b = pixel(p, Math.max(from, cursor));
      for (const [key, value] of Object.entries({x: a, y: p.top, width: b - a, height: p.height, visibility: 'visible'}))
        p.chosen.setAttribute(key, value);
    });
    const end = event => {
      if (from === null) return;
      const to = timeAt(event), range = [Math.min(from, to), Math.max(from, to)];
      from = null;
      p.chosen.setAttribute('visibility', 'hidden');
      if (range[1] - range[0] > 0.01 * (shown[1] - shown[0])) show(range);
    };
    window.addEventListener('pointerup', end);
    window.addEventListener('pointercancel', () => { from = null; p.chosen.setAttribute('visibility', 'hidden'); });
    p.svg.addEventListener('pointerleave', () => { if (from === null) { cursor = null; drawCursor(); } });
    p.svg.addEventListener('dblclick', () => show(whole));
    p.svg.addEventListener('keydown', event => {
      if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
      keys[event.key](event);
      event.preventDefault();
    });
  });
  document.getElementById('whole').addEventListener('click', () => show(whole));
  window.addEventListener('resize', () => plots.forEach(drawTicks));
  show(whole);
})();
</script>
)js";
}

}  // namespace musclesim
