// Space to walk around in: sheets, balls, lines. Balls are drawn exactly, one square each.
import {
  AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, GLSL3, InstancedBufferAttribute,
  InstancedBufferGeometry, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial, PerspectiveCamera, Plane, Scene,
  ShaderMaterial, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { offer, save } from "./links.js";
import { unpack } from "./unpack.js";

const viridis = [[68, 1, 84], [71, 45, 123], [59, 82, 139], [44, 114, 142], [33, 145, 140], [40, 174, 128], [94, 201, 98], [173, 220, 48], [253, 231, 37]];

function shadeOf(value) {
  const at = (value / 255) * 8, k = Math.min(7, Math.floor(at)), w = at - k;
  return viridis[k].map((v, c) => ((1 - w) * v + w * viridis[k + 1][c]) / 255);
}

function coloursOf(count, colour, shades, each) {
  const out = new Float32Array(3 * count * each), plain = new Color(colour).getRGB({}, "srgb");
  for (let k = 0; k < count; ++k) {
    const rgb = shades ? shadeOf(shades[k]) : [plain.r, plain.g, plain.b];
    for (let e = 0; e < each; ++e) out.set(rgb, 3 * (k * each + e));
  }
  return out;
}

const toLengths = (values, extent) => Float32Array.from(values, (v) => (v / 65535) * extent);

/// Balls as squares that face the viewer and carve the ball out of themselves, with true depth.
function ballMaterial(cut) {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    uniforms: { cut: { value: cut } },
    vertexShader: `
      in vec3 centre; in float radius; in vec3 tint;
      uniform vec4 cut;
      out vec2 corner; out vec3 middle; out vec3 paint; flat out float size; flat out float off;
      void main() {
        corner = position.xy * 1.15; paint = tint; size = radius;
        off = dot(cut.xyz, centre) + cut.w;
        vec4 seen = modelViewMatrix * vec4(centre, 1.0);
        middle = seen.xyz;
        gl_Position = projectionMatrix * vec4(seen.xy + corner * radius, seen.z, 1.0);
      }`,
    fragmentShader: `
      uniform mat4 projectionMatrix;
      in vec2 corner; in vec3 middle; in vec3 paint; flat in float size; flat in float off;
      out vec4 colour;
      void main() {
        if (off < 0.0) discard;
        vec3 ray = normalize(vec3(middle.xy + corner * size, middle.z));
        float along = dot(ray, middle), inside = size * size - dot(middle, middle) + along * along;
        if (inside < 0.0) discard;
        vec3 hit = ray * (along - sqrt(inside)), n = (hit - middle) / size;
        float light = 0.36 + 0.66 * max(0.0, dot(n, normalize(vec3(-0.4, 0.52, 0.755))));
        colour = vec4(paint * light, 1.0);
        vec4 clip = projectionMatrix * vec4(hit, 1.0);
        gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
      }`,
  });
}

async function ballsOf(part, extent, cut) {
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const shades = part.shade && (await unpack(part.shade, Uint8Array));
  geometry.setAttribute("centre", new InstancedBufferAttribute(toLengths(await unpack(part.points, Uint16Array), extent), 3));
  geometry.setAttribute("radius", new InstancedBufferAttribute(toLengths(await unpack(part.radii, Uint16Array), extent), 1));
  geometry.setAttribute("tint", new InstancedBufferAttribute(coloursOf(part.count, part.colour, shades, 1), 3));
  geometry.instanceCount = part.count;
  const mesh = new Mesh(geometry, ballMaterial(cut));
  mesh.frustumCulled = false;
  return mesh;
}

async function sheetOf(part, extent, planes) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(toLengths(await unpack(part.points, Uint16Array), extent), 3));
  const corners = await unpack(part.corners, Int32Array);
  for (let k = 1; k < corners.length; ++k) corners[k] += corners[k - 1];
  geometry.setIndex(new BufferAttribute(new Uint32Array(corners.buffer), 1));
  return new Mesh(geometry, new MeshLambertMaterial({ color: part.colour, side: DoubleSide, flatShading: true, clippingPlanes: planes }));
}

async function linesOf(part, extent, planes) {
  const geometry = new BufferGeometry();
  const shades = part.shade && (await unpack(part.shade, Uint8Array));
  geometry.setAttribute("position", new BufferAttribute(toLengths(await unpack(part.points, Uint16Array), extent), 3));
  const colours = coloursOf(part.count, part.colour, shades, 2);
  for (let k = 0; k < colours.length; ++k) colours[k] **= 2.2;
  geometry.setAttribute("color", new BufferAttribute(colours, 3));
  return new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true, clippingPlanes: planes }));
}

function frameOf(box, ink) {
  const points = [];
  for (let axis = 0; axis < 3; ++axis)
    for (let corner = 0; corner < 4; ++corner) {
      const from = [0, 0, 0];
      from[(axis + 1) % 3] = corner & 1 ? box[(axis + 1) % 3] : 0;
      from[(axis + 2) % 3] = corner & 2 ? box[(axis + 2) % 3] : 0;
      const to = [...from];
      to[axis] = box[axis];
      points.push(...from, ...to);
    }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color: ink }));
}

function node(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

export async function showScene(figure, data) {
  const canvas = node("canvas");
  let renderer;
  try {
    renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  } catch {
    figure.dataset.still = "no WebGL here: the picture stays";
    return;
  }
  renderer.localClippingEnabled = true;
  renderer.setPixelRatio(Math.min(2, devicePixelRatio));
  const stage = node("div", { className: "stage" }, canvas);
  const scene = new Scene();
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const ground = () => {
    scene.background = new Color(dark.matches ? 0x14171a : 0xffffff);
  };
  ground();
  scene.add(new AmbientLight(0xffffff, 0.75));
  const light = new DirectionalLight(0xffffff, 2.6);
  scene.add(light);

  const box = new Vector3(...data.box), centre = box.clone().multiplyScalar(0.5), reach = box.length();
  const camera = new PerspectiveCamera(30, 1, reach / 100, reach * 10);
  camera.up.set(0, 0, 1);
  camera.position.copy(centre).add(new Vector3(0.76, 0.53, 0.375).multiplyScalar(reach * 1.95));
  const controls = new OrbitControls(camera, canvas);
  controls.target.copy(centre);

  const plane = new Plane(new Vector3(0, 0, 1), 1e9), cut = { x: 0, y: 0, z: 1, w: 1e9 };
  scene.add(frameOf(data.box, dark.matches ? 0x8a929c : 0x5a6068));
  const bar = node("div", { className: "bar" });
  let queued = false;
  const draw = () => {
    if (queued) return;
    queued = true;
    requestAnimationFrame(() => {
      queued = false;
      light.position.copy(new Vector3(-0.9, 1.1, 1.6).applyQuaternion(camera.quaternion).multiplyScalar(reach)).add(centre);
      light.target.position.copy(centre);
      light.target.updateMatrixWorld();
      renderer.render(scene, camera);
      figure.dataset.drawn = String(Number(figure.dataset.drawn ?? 0) + 1);
    });
  };
  const makers = { balls: (p) => ballsOf(p, data.extent, cut), sheet: (p) => sheetOf(p, data.extent, [plane]), lines: (p) => linesOf(p, data.extent, [plane]) };
  for (const part of data.parts) {
    if (!part.count) continue;
    const object = await makers[part.kind](part);
    object.visible = part.hidden !== true;
    scene.add(object);
    const toggle = node("input", { type: "checkbox", checked: object.visible });
    toggle.addEventListener("change", () => ((object.visible = toggle.checked), draw()));
    const swatch = node("span", { className: "swatch" });
    swatch.style.background = part.shade ? "linear-gradient(90deg,#440154,#21918c,#fde725)" : part.colour;
    bar.append(node("label", {}, toggle, swatch, `${part.name} (${part.count.toLocaleString("en")})`));
  }
  const axis = node("select", { ariaLabel: "cut across" }, ...["z", "x", "y"].map((a) => node("option", { value: a, textContent: `cut across ${a}` })));
  const depth = node("input", { type: "range", min: 0, max: 100, value: 100, ariaLabel: "position of the cut" });
  const moved = () => {
    const at = (depth.value / 100) * box[axis.value] + (depth.value === "100" ? reach : 0);
    plane.normal.set(0, 0, 0);
    plane.normal[axis.value] = -1;
    plane.constant = at;
    Object.assign(cut, { x: plane.normal.x, y: plane.normal.y, z: plane.normal.z, w: at });
    draw();
  };
  axis.addEventListener("change", moved);
  depth.addEventListener("input", moved);
  bar.append(axis, depth);
  if (data.shade) bar.append(node("span", { className: "soft", textContent: `${data.shade.title}: ${data.shade.least} (dark) to ${data.shade.most} (yellow)` }));
  bar.append(node("span", { className: "soft", textContent: `box ${data.box.map((v) => Number(v.toPrecision(4))).join(" × ")} ${data.unit} (x, y, z)` }));

  figure.prepend(stage);
  stage.after(bar);
  figure.classList.add("live");
  const resize = () => {
    const { clientWidth: w, clientHeight: h } = stage;
    if (!w || !h) return;
    renderer.setSize(w, h, false);
    camera.aspect = w / h;
    camera.updateProjectionMatrix();
    draw();
  };
  canvas.style.height = "100%";
  new ResizeObserver(resize).observe(stage);
  dark.addEventListener("change", () => (ground(), draw()));
  controls.addEventListener("change", draw);
  moved();
  resize();
  offer(figure, "png", () => canvas.toBlob((blob) => save(`${figure.id}.png`, "image/png", blob)));
}
