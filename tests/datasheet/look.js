// Runs in the page: finds texts that cannot be read, and prints them as JSON at its end.
const LEAST_TEXT = 4.5;  // WCAG 2.1, 1.4.3 (AA)
const LEAST_LINE = 3;  // WCAG 2.1, 1.4.11
const found = {
  dark: matchMedia('(prefers-color-scheme: dark)').matches,
  texts: 0, lines: 0, faint: [], outside: [], overlapping: [],
  wide: document.documentElement.scrollWidth - innerWidth,
};

function rgba(color) {
  const [r, g, b, a = 1] = color.match(/[\d.]+/g).map(Number);
  return {r, g, b, a};
}

function luminance(color) {
  const [r, g, b] = [color.r, color.g, color.b].map((value) => {
    const part = value / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function contrast(one, other) {
  const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
  return (high + 0.05) / (low + 0.05);
}

function paperBehind(element) {
  for (let one = element; one; one = one.parentElement) {
    const color = rgba(getComputedStyle(one).backgroundColor);
    if (color.a) return color;
  }
  return {r: 255, g: 255, b: 255, a: 1};
}

function fillBehind(text, x, y) {
  for (const one of document.elementsFromPoint(x, y)) {
    const style = getComputedStyle(one);
    if (one.tagName === 'text' || !one.closest('svg')) continue;
    if (one.tagName !== 'svg' && style.fill !== 'none') return rgba(style.fill);
  }
  return paperBehind(text.closest('svg'));
}

function judge(name, color, background, least) {
  const ratio = contrast(color, background);
  if (!(ratio >= least)) found.faint.push(`${name}: ${ratio.toFixed(2)}`);
}

for (const element of document.body.querySelectorAll('*:not(script)')) {
  const texts = [...element.childNodes].filter((node) => node.nodeType === 3 && node.data.trim());
  if (!texts.length || element.closest('svg')) continue;
  found.texts += 1;
  judge(texts[0].data, rgba(getComputedStyle(element).color), paperBehind(element), LEAST_TEXT);
}

for (const svg of document.querySelectorAll('svg')) {
  const frame = svg.getBoundingClientRect();
  const boxes = [];
  for (const text of svg.querySelectorAll('text')) {
    const box = text.getBoundingClientRect();
    const color = rgba(getComputedStyle(text).fill);
    found.texts += 1;
    const [x, y] = [(box.left + box.right) / 2, (box.top + box.bottom) / 2];
    judge(text.textContent, color, fillBehind(text, x, y), LEAST_TEXT);
    if (box.left < frame.left || box.right > frame.right || box.top < frame.top ||
        box.bottom > frame.bottom) found.outside.push(text.textContent);
    // Lines of text are higher than their letters: a quarter of it is air.
    const air = Math.min(box.width, box.height) / 4;
    const turned = text.getAttribute('transform')?.startsWith('rotate');
    const [flat, tall] = turned ? [air, 0] : [0, air];
    boxes.push({name: text.textContent, left: box.left + flat, right: box.right - flat,
      top: box.top + tall, bottom: box.bottom - tall});
  }
  boxes.forEach((one, index) => boxes.slice(index + 1).forEach((other) => {
    if (one.left < other.right && other.left < one.right && one.top < other.bottom &&
        other.top < one.bottom) found.overlapping.push(`${one.name} and ${other.name}`);
  }));
  const board = svg.querySelector('.board');
  for (const line of svg.querySelectorAll('.wire, .coil, .curve')) {
    const color = rgba(getComputedStyle(line).stroke);
    found.lines += 1;
    judge(line.getAttribute('class'), color, paperBehind(svg), LEAST_LINE);
    if (board) judge(`${line.getAttribute('class')} on the board`, color,
      rgba(getComputedStyle(board).fill), LEAST_LINE);
  }
}

const shown = document.createElement('pre');
shown.id = 'found';
shown.textContent = JSON.stringify(found);
document.body.append(shown);
