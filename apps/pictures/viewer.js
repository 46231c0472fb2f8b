// Shows the scene of the page. Colors are made by the tool: they are those of its pictures.
(() => {
const scene = JSON.parse(document.getElementById('scene').textContent);
const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));
const floats = text => new Float32Array(bytes(text).buffer);
const view = document.getElementById('view');

// Discs that face the camera; those whose surface is seen from the side are darker, as with a lamp at the camera.
const vertexShader = `
attribute vec3 color;
attribute float shaded;
uniform float size;
uniform vec2 light;
varying vec3 shade;
void main() {
  vec4 p = modelViewMatrix * vec4(position, 1.0);
  // Without normals there is nothing to normalize: the result would not be a number, and the point black.
  float facing = shaded > 0.5 ? abs(dot(normalize(normalMatrix * normal), normalize(p.xyz))) : 1.0;
  shade = color * (light.x + light.y * facing);
  gl_Position = projectionMatrix * p;
  gl_PointSize = max(1.5, size / -p.z);
}`;
const fragmentShader = `
varying vec3 shade;
void main() {
  vec2 q = gl_PointCoord - 0.5;
  if (dot(q, q) > 0.25) discard;
  gl_FragColor = vec4(shade, 1.0);
}`;

function attribute(geometry, name, array, size, normalized = false) {
  geometry.setAttribute(name, new THREE.BufferAttribute(array, size, normalized));
}

function makePoints() {
  const geometry = new THREE.BufferGeometry();
  const position = floats(scene.points);
  attribute(geometry, 'position', position, 3);
  const has_normals = scene.normals.length > 0;
  attribute(geometry, 'normal', has_normals ? new Int8Array(bytes(scene.normals).buffer) : new Int8Array(position.length), 3, true);
  attribute(geometry, 'shaded', new Float32Array(position.length / 3).fill(has_normals ? 1 : 0), 1);
  attribute(geometry, 'color', new Uint8Array(position.length), 3, true);
  const material = new THREE.ShaderMaterial({vertexShader, fragmentShader, uniforms: {size: {value: 1}, light: {value: [1, 0]}}});
  return new THREE.Points(geometry, material);
}

function makeMesh() {
  const geometry = new THREE.BufferGeometry();
  attribute(geometry, 'position', floats(scene.mesh), 3);
  attribute(geometry, 'color', new Uint8Array(geometry.attributes.position.array.length), 3, true);
  geometry.computeVertexNormals();
  return new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1}));
}

function makePlane(plane) {
  const [a, b, c, d] = plane.corners;
  const group = new THREE.Group();
  const patch = new THREE.BufferGeometry(), outline = new THREE.BufferGeometry();
  attribute(patch, 'position', new Float32Array([a, b, c, a, c, d].flat()), 3);
  attribute(outline, 'position', new Float32Array([a, b, c, d].flat()), 3);
  const color = new THREE.Color(plane.color);
  group.add(new THREE.Mesh(patch, new THREE.MeshBasicMaterial({color, transparent: true, opacity: 0.25, side: THREE.DoubleSide, depthWrite: false})));
  group.add(new THREE.LineLoop(outline, new THREE.LineBasicMaterial({color})));
  return group;
}

// A rod, as lines are a pixel wide in most browsers. It shines through the surface that hides it.
function makeAxis(axis) {
  const [a, b] = axis.ends.map(end => new THREE.Vector3(...end)), along = b.clone().sub(a).normalize();
  const u = new THREE.Vector3(1, 0, 0).cross(along).lengthSq() > 0.1 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0);
  u.cross(along).normalize();
  const v = along.clone().cross(u), corners = [], sides = 12, radius = 0.007;
  const corner = (end, i) => end.clone().addScaledVector(u, radius * Math.cos(2 * Math.PI * i / sides)).addScaledVector(v, radius * Math.sin(2 * Math.PI * i / sides)).toArray();
  for (let i = 0; i < sides; ++i) corners.push(corner(a, i), corner(a, i + 1), corner(b, i), corner(b, i), corner(a, i + 1), corner(b, i + 1));
  const rod = new THREE.BufferGeometry(), group = new THREE.Group();
  attribute(rod, 'position', new Float32Array(corners.flat()), 3);
  for (const [opacity, depthTest] of [[1, true], [0.35, false]])
    group.add(new THREE.Mesh(rod, new THREE.MeshBasicMaterial({color: axis.color, transparent: !depthTest, opacity, depthTest, depthWrite: depthTest, side: THREE.DoubleSide})));
  return group;
}

let renderer;
try {
  renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
} catch (error) {
  view.innerHTML = '<p id="failure">This browser shows no WebGL.</p>';
  return;
}
// Colors are written as they are: those of the PNG pictures are not managed either.
renderer.outputColorSpace = 'srgb-linear';
const managed = color => new THREE.Color().setRGB(color[0], color[1], color[2], 'srgb-linear');
renderer.setClearColor(0xffffff);
renderer.setPixelRatio(window.devicePixelRatio);
view.appendChild(renderer.domElement);
const world = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(25, 1, 0.01, 100);
const up = new THREE.Vector3(...scene.up), towards = new THREE.Vector3(...scene.view).normalize();
camera.up.copy(up);
camera.position.copy(towards.multiplyScalar(2.7));
const lamp = new THREE.DirectionalLight(0xffffff, 2.4);
camera.add(lamp);
world.add(camera, new THREE.HemisphereLight(0xffffff, 0xffffff, 0.8));
let controls = new THREE.OrbitControls(camera, renderer.domElement);
const points = scene.points ? makePoints() : null, mesh = scene.mesh ? makeMesh() : null;
for (const object of [points, mesh]) if (object) world.add(object);
for (const panel of scene.panels) {
  panel.group = new THREE.Group();
  for (const plane of panel.planes) panel.group.add(makePlane({...plane, color: managed(plane.color)}));
  for (const axis of panel.axes) panel.group.add(makeAxis({...axis, color: managed(axis.color)}));
  world.add(panel.group);
}

function paint(object, colors, plain) {
  if (!object) return;
  const target = object.geometry.attributes.color;
  const source = colors ? bytes(colors) : null;
  for (let i = 0; i < target.array.length; ++i) target.array[i] = source ? source[i] : plain[i % 3];
  target.needsUpdate = true;
}

let shown = 0;
function show(index) {
  shown = (index + scene.panels.length) % scene.panels.length;
  const panel = scene.panels[shown];
  paint(points, panel.point_colors, scene.plain_point);
  paint(mesh, panel.mesh_colors, scene.plain_mesh);
  if (points) {
    points.visible = panel.show_points;
    points.material.uniforms.light.value = panel.shade;
  }
  scene.panels.forEach((other, i) => { other.group.visible = i === shown; });
  document.getElementById('legend').style.display = panel.has_support ? '' : 'none';
  [...document.getElementById('panels').children].forEach((button, i) => { button.className = i === shown ? 'shown' : ''; });
  draw();
}

function draw() { renderer.render(world, camera); }

function resize() {
  const width = view.clientWidth, height = view.clientHeight;
  renderer.setSize(width, height);
  camera.aspect = width / height;
  // The whole scene also where the window is narrow.
  camera.fov = camera.aspect >= 1 ? 25 : 2 * Math.atan(Math.tan(25 * Math.PI / 360) / camera.aspect) * 180 / Math.PI;
  camera.updateProjectionMatrix();
  if (points) points.material.uniforms.size.value = scene.point_size * height * window.devicePixelRatio / Math.tan(camera.fov * Math.PI / 360);
  draw();
}

document.title = scene.title;
document.getElementById('title').textContent = scene.title;
document.getElementById('text').textContent = scene.text;
if (scene.picture) {
  const pixels = bytes(scene.picture.pixels), {width} = scene.picture, canvas = document.getElementById('picture');
  const image = new ImageData(width, pixels.length / 3 / width);
  for (let i = 0; i < pixels.length / 3; ++i) image.data.set([...pixels.subarray(3 * i, 3 * i + 3), 255], 4 * i);
  canvas.width = width;
  canvas.height = image.height;
  canvas.getContext('2d').putImageData(image, 0, 0);
  canvas.style.display = 'block';
}
document.getElementById('bar').style.background = 'linear-gradient(to right,' + scene.support_colors.join(',') + ')';
scene.panels.forEach((panel, i) => {
  const button = document.createElement('button');
  for (const part of [...panel.planes, ...panel.axes, ...panel.segments]) {
    const swatch = document.createElement('span');
    swatch.className = 'swatch';
    swatch.style.background = 'rgb(' + part.color.map(c => Math.round(255 * c)).join(',') + ')';
    button.appendChild(swatch);
  }
  button.appendChild(document.createTextNode(panel.label));
  button.addEventListener('click', () => show(i));
  document.getElementById('panels').appendChild(button);
});
// What is up is known of few files: the reader chooses.
for (const [label, direction] of [['up: x', [1, 0, 0]], ['y', [0, 1, 0]], ['z', [0, 0, 1]], ['-y', [0, -1, 0]], ['as before', scene.up]]) {
  const button = document.createElement('button');
  button.textContent = label;
  button.addEventListener('click', () => turnUp(new THREE.Vector3(...direction)));
  document.getElementById('turns').appendChild(button);
}
window.addEventListener('keydown', event => {
  if (event.key === 'ArrowRight' || event.key === 'ArrowDown') show(shown + 1);
  if (event.key === 'ArrowLeft' || event.key === 'ArrowUp') show(shown - 1);
});
window.addEventListener('resize', resize);
controls.addEventListener('change', draw);

function turnUp(direction) {
  camera.up.copy(direction);
  const side = Math.abs(direction.x) < 0.5 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0);
  const across = direction.clone().cross(side).normalize();
  camera.position.copy(across.multiplyScalar(0.75).add(side.multiplyScalar(0.45)).addScaledVector(direction, 0.45).normalize().multiplyScalar(2.7));
  if (direction.equals(up)) camera.position.copy(towards);
  // The controls take what is up when they are made.
  controls.dispose();
  controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.addEventListener('change', draw);
  controls.update();
  draw();
}
// A page opened as FILE.html#2 begins with the second entry of the list.
show(Math.max(0, (parseInt(location.hash.slice(1), 10) || 1) - 1));
resize();
document.body.dataset.ready = 'true';
})();
