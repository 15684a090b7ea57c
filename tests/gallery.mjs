// Opens the gallery's page, or one of `ricci view`, from disk in headless Chromium, over a pipe of the DevTools protocol: no message of an
// error, no request beside the page, every view is drawn, a drag turns the surface, a place that is pointed at on either side is marked on both
// and is the same place of both, controls change both sides, and a quantity has its legend.
// node gallery.mjs CHROMIUM PAGE PROFILE [SCREENSHOT.png]
import { spawn } from "node:child_process";
import { writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [browser, file, profile, screenshot] = process.argv.slice(2);
const PATIENCE = 300; // seconds for the whole
const flags = [
  "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars",
  "--window-size=1200,900", `--user-data-dir=${profile}`, "--remote-debugging-pipe", "about:blank",
];
const chromium = spawn(browser, flags, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
const end = (code, words) => {
  (code === 0 ? console.log : console.error)(words);
  chromium.once("exit", () => process.exit(code));
  chromium.kill();
  setTimeout(() => process.exit(code), 5000);
};
setTimeout(() => end(1, `no end after ${PATIENCE} s`), 1000 * PATIENCE);
chromium.on("error", (error) => end(1, error.message));

const waiting = new Map();
const troubles = [];
const requests = [];
let session;
let last = 0;
let text = "";

function send(method, params = {}) {
  last += 1;
  chromium.stdio[3].write(`${JSON.stringify({ id: last, method, params, sessionId: session })}\0`);
  return new Promise((done, fail) => waiting.set(last, { done, fail }));
}

function heard({ id, method, params, result, error }) {
  if (id !== undefined) {
    const { done, fail } = waiting.get(id);
    waiting.delete(id);
    if (error) fail(new Error(error.message)); else done(result);
  } else if (method === "Runtime.exceptionThrown") {
    troubles.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
  } else if (method === "Runtime.consoleAPICalled" && ["error", "warning", "assert"].includes(params.type)) {
    troubles.push(params.args.map((a) => a.value ?? a.description).join(" "));
  } else if (method === "Log.entryAdded" && params.entry.level === "error") {
    troubles.push(params.entry.text);
  } else if (method === "Network.requestWillBeSent") {
    requests.push(params.request.url);
  }
}

chromium.stdio[4].setEncoding("utf8");
chromium.stdio[4].on("data", (more) => {
  const messages = (text + more).split("\0");
  text = messages.pop();
  messages.forEach((message) => heard(JSON.parse(message)));
});

const pause = (ms) => new Promise((done) => setTimeout(done, ms));
async function value(expression) {
  const { result, exceptionDetails } = await send("Runtime.evaluate", { expression, returnByValue: true, awaitPromise: true });
  if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
  return result.value;
}
async function until(expression, what) {
  for (let k = 0; k < 300; k++) {
    if (await value(expression)) return;
    await pause(100);
  }
  throw new Error(`${what} has not come; trouble: ${await value("document.getElementById('trouble').textContent")}`);
}
function check(holds, words) {
  if (!holds) throw new Error(words);
}
const mouse = (type, x, y, buttons = 0) => {
  const button = buttons || type === "mouseReleased" ? "left" : "none";
  return send("Input.dispatchMouseEvent", { type, x, y, buttons, button, clickCount: button === "left" ? 1 : 0 });
};

// What can be chosen below a view changes both of its sides, and chosen back gives the picture of before.
async function controls(canvas, left, right) {
  await mouse("mouseMoved", 1, 1);
  await pause(300);
  const row = `${canvas}.nextElementSibling.nextElementSibling`;
  const parts = `${row}.querySelectorAll("input, select")`;
  const kinds = await value(`[...${parts}].map((part) => part.type)`);
  check(kinds.includes("range"), `a view of a layout has no density of checks: ${kinds}`);
  for (let k = 0; k < kinds.length; k++) {
    const before = [await left(), await right()];
    const turn = (back) => value(`(() => { const p = ${parts}[${k}];
      if (p.type === "checkbox") p.checked = ${back}; else if (p.type === "range") p.value = ${back} ? 24 : 60; else p.selectedIndex = ${back} ? 1 : 0;
      p.dispatchEvent(new Event(p.type === "range" ? "input" : "change")); })()`);
    const legend = () => value(`${row}.querySelector("span").textContent`);
    if (kinds[k] === "select-one") check(/\d \(dark\) to -?\d.* \(light\)$/.test(await legend()), `legend: ${await legend()}`);
    await turn(false);
    await pause(400);
    if (kinds[k] === "select-one") check((await legend()) === "", "a legend without a quantity");
    check((await left()) !== before[0] && (await right()) !== before[1], `${kinds[k]} changes nothing`);
    await turn(true);
    await pause(400);
    check((await left()) === before[0] && (await right()) === before[1], `${kinds[k]} does not go back`);
  }
}

// What is said of a place that is pointed at, on a grid over one half of a view; fails where no place of the grid is marked on both sides.
async function said(canvas, box, half) {
  for (let k = 0; k < 25; k++) {
    const at = [box[0] + box[2] * (0.5 * half + 0.15 + 0.05 * (k % 5)), box[1] + box[3] * (0.3 + 0.1 * Math.floor(k / 5))];
    await mouse("mouseMoved", ...at);
    await pause(150);
    if ((await value(`Number(${canvas}.dataset.marks)`)) === 2) return value(`${canvas}.nextElementSibling.textContent`);
  }
  throw new Error(`a place that is pointed at on side ${half} is not marked on both sides`);
}

// Whether the two places that are said are one place of the surface: some face has both, with the same weights of its corners.
async function corresponds(canvas, words) {
  const [, on, beside] = words.match(/^\((.+)\) on the surface, \((.+)\) beside it/).map((text) => text.split(", ").map(Number));
  const data = await value(`JSON.parse(document.getElementById("views").textContent)[${canvas}.dataset.view]`);
  const bytes = (text) => Buffer.from(text, "base64");
  const points = ({ from, step, data: text }) => {
    const raw = bytes(text);
    return (v) => [0, 1, 2].map((j) => from[j] + step * raw.readUInt16LE(6 * v + 2 * j));
  };
  const [surface, image, raw] = [points(data.surface), points(data.image), bytes(data.corners)];
  const corner = (k) => (data.wide ? raw.readUInt32LE(4 * k) : raw.readUInt16LE(2 * k));
  const area = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  let nearest = Infinity;
  for (let f = 0; f < data.faces; f++) {
    const corners = [0, 1, 2].map((k) => corner(3 * f + k));
    const [a, b, c] = corners.map(image);
    const weights = [area(beside, b, c), area(a, beside, c), area(a, b, beside)].map((x) => x / area(a, b, c));
    // Numbers are said with five digits.
    if (!(Math.min(...weights) > -0.05)) continue;
    const place = [0, 1, 2].map((j) => corners.reduce((sum, v, k) => sum + weights[k] * surface(v)[j], 0));
    nearest = Math.min(nearest, Math.hypot(...place.map((x, j) => x - on[j])));
  }
  check(nearest < 2e-3 * 65535 * data.surface.step, `${words}: these places are ${nearest} apart on the surface`);
}

async function look() {
  const { targetInfos } = await send("Target.getTargets");
  const { targetId } = targetInfos.find((target) => target.type === "page");
  session = (await send("Target.attachToTarget", { targetId, flatten: true })).sessionId;
  for (const domain of ["Page", "Runtime", "Log", "Network"]) await send(`${domain}.enable`);
  const address = pathToFileURL(resolve(file)).href;
  await send("Page.navigate", { url: address });
  await until("document.readyState === 'complete' && location.protocol === 'file:'", "the page");

  const views = await value("document.querySelectorAll('canvas[data-view]').length");
  check(views > 0, "the page has no view");
  const canvas = (k) => `document.querySelectorAll('canvas[data-view]')[${k}]`;
  for (let k = 0; k < views; k++) {
    await value(`${canvas(k)}.scrollIntoView({ block: "center" })`);
    await until(`Number(${canvas(k)}.dataset.drawn) > 0`, `view ${k}`);
    // Colours away from white, in a sample of the canvas's pixels.
    const inked = await value(`(() => { const c = ${canvas(k)}; const d = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
      let n = 0; for (let i = 0; i < d.length; i += 4) if (d[i] + d[i + 1] + d[i + 2] < 740) n++; return n / (d.length / 4); })()`);
    const name = await value(`${canvas(k)}.dataset.view`);
    check(inked > 0.005, `${name}: only ${inked} of its pixels are drawn on`);
  }

  // The first view with two sides, the right one a layout in the plane.
  const flat = await value("(() => { const v = JSON.parse(document.getElementById('views').textContent);"
    + " return [...document.querySelectorAll('canvas[data-view]')].findIndex((c) => v[c.dataset.view].flat); })()");
  check(flat >= 0, "no view has a layout");
  await value(`${canvas(flat)}.scrollIntoView({ block: "center" })`);
  await pause(300);
  const box = await value(`(() => { const b = ${canvas(flat)}.getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()`);
  const [x, y] = [box[0] + 0.25 * box[2], box[1] + 0.5 * box[3]];
  const [left, right] = ["0, 0, c.width >> 1, c.height", "c.width >> 1, 0, c.width >> 1, c.height"].map(
    (part) => () => value(`(() => { const c = ${canvas(flat)}; const d = c.getContext("2d").getImageData(${part}).data; let h = 0;
      for (let i = 0; i < d.length; i++) h = (Math.imul(h, 31) + d[i]) | 0; return h; })()`),
  );
  const before = [await left(), await right()];
  await mouse("mouseMoved", 1, 1);
  await mouse("mousePressed", x, y, 1);
  for (let k = 1; k <= 8; k++) await mouse("mouseMoved", x + 8 * k, y + 3 * k, 1);
  await mouse("mouseReleased", x + 64, y + 24, 0);
  await mouse("mouseMoved", 1, 1);
  await pause(500);
  check((await left()) !== before[0], "a drag does not turn the surface");
  check((await right()) === before[1], "a drag of the surface changes the layout");

  for (const half of [0, 1]) {
    const words = await said(canvas(flat), box, half);
    check((await right()) !== before[1], "no mark is seen beside the surface");
    check(/on the surface, \(.+, .+\) beside it(; .+)?$/.test(words), `said: ${words}`);
    await corresponds(canvas(flat), words);
  }
  await controls(canvas(flat), left, right);
  if (screenshot) writeFileSync(screenshot, Buffer.from((await send("Page.captureScreenshot")).data, "base64"));

  const beside = requests.filter((url) => url !== address && !url.startsWith("data:"));
  check(beside.length === 0, `requests beside the page: ${beside}`);
  check(troubles.length === 0, `errors of the page: ${troubles.join("; ")}`);
  return `${views} views of ${file} are drawn; a drag turns a surface, places on both sides are the same, no errors, no requests`;
}

look().then((words) => end(0, words), (error) => end(1, `${file}: ${error.message}`));
