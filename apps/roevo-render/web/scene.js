'use strict';
// What is shown, as objects of three.js. Axes: x forward, y left, z up; metres.
const roevo = {background: [14, 17, 23]};

// ---- the data as it comes: base64, numbers with the least significant byte first

roevo.bytes = function (text) {
    const raw = atob(text), bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
    return bytes;
};

roevo.floats = text => new Float32Array(roevo.bytes(text).buffer);

// Positions of a layer's points: each block of them has a box of its own, in whose steps they are given.
roevo.positions = function (layer) {
    const boxes = roevo.floats(layer.boxes), steps = new Uint16Array(roevo.bytes(layer.positions).buffer);
    const positions = new Float32Array(3 * layer.count);
    for (let i = 0; i < layer.count; ++i) {
        const box = 4 * Math.floor(i / layer.block), step = boxes[box + 3];
        for (let axis = 0; axis < 3; ++axis)
            positions[3 * i + axis] = boxes[box + axis] + steps[3 * i + axis] * step;
    }
    return positions;
};

// ---- lines of any width, and points: each colour has a fourth byte, how visible the line is that ends in its point

roevo.uniforms = {  // shared by all
    viewport: {value: new THREE.Vector2(1, 1)},  // px
    pixel: {value: 1},                           // device pixels per px
    near: {value: 0.01},                         // m
    background: {value: new THREE.Vector3().fromArray(roevo.background).divideScalar(255)}
};

const kShownColour = `
    uniform vec3 background;
    uniform float darkest;
    vec3 shown(vec4 colour) {
        float brightness = max(colour.r, max(colour.g, colour.b));
        return mix(background, colour.rgb + max(darkest - brightness, 0.0), colour.a);
    }`;

const kLineShader = kShownColour + `
    attribute vec3 from, to;
    attribute vec4 fromColour, toColour;
    uniform vec2 viewport;
    uniform float width, near;
    varying vec3 vColour;
    void main() {
        vColour = shown(vec4(position.x < 0.5 ? fromColour.rgb : toColour.rgb, toColour.a));
        vec4 a = modelViewMatrix * vec4(from, 1.0), b = modelViewMatrix * vec4(to, 1.0);
        if (toColour.a == 0.0 || (a.z > -near && b.z > -near)) {
            gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside
            return;
        }
        if (a.z > -near) a = mix(a, b, (a.z + near) / (a.z - b.z));
        if (b.z > -near) b = mix(b, a, (b.z + near) / (b.z - a.z));
        a = projectionMatrix * a;
        b = projectionMatrix * b;
        vec2 along = (b.xy / b.w - a.xy / a.w) * viewport;
        along = length(along) > 1e-4 ? normalize(along) : vec2(1.0, 0.0);
        vec2 side = vec2(-along.y, along.x) * position.y + along * (2.0 * position.x - 1.0);
        gl_Position = position.x < 0.5 ? a : b;
        gl_Position.xy += side * width / viewport * gl_Position.w;
    }`;

const kPointShader = kShownColour + `
    attribute vec4 colour;
    uniform vec2 viewport;
    uniform float size, pixel;
    varying vec3 vColour;
    void main() {
        vColour = shown(colour);
        vec4 p = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * p;
        gl_PointSize = clamp(0.5 * size * projectionMatrix[1][1] * viewport.y / max(-p.z, 1e-3), 1.6 * pixel, 14.0 * pixel);
    }`;

roevo.material = function (vertexShader, own) {
    return new THREE.ShaderMaterial({
        uniforms: Object.assign({}, roevo.uniforms, own),
        vertexShader,
        fragmentShader: 'varying vec3 vColour; void main() { gl_FragColor = vec4(vColour, 1.0); }',
        side: THREE.DoubleSide
    });
};

// A line from each point to the next. look: {width (px), darkest (brightness at least, 0..1)}
roevo.lines = function (positions, colours, look) {
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(
        new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]), 3));  // which end, which side
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const places = new THREE.InstancedInterleavedBuffer(positions, 3, 1);
    const paint = new THREE.InstancedInterleavedBuffer(colours, 4, 1);
    geometry.setAttribute('from', new THREE.InterleavedBufferAttribute(places, 3, 0));
    geometry.setAttribute('to', new THREE.InterleavedBufferAttribute(places, 3, 3));  // the next point
    geometry.setAttribute('fromColour', new THREE.InterleavedBufferAttribute(paint, 4, 0, true));
    geometry.setAttribute('toColour', new THREE.InterleavedBufferAttribute(paint, 4, 4, true));
    geometry.maxInstancedCount = Math.max(0, positions.length / 3 - 1);
    const width = {value: look.width};
    const mesh = new THREE.Mesh(geometry, roevo.material(kLineShader, {width, darkest: {value: look.darkest || 0}}));
    mesh.frustumCulled = false;  // three.js would look at the first four points only
    mesh.onBeforeRender = () => { width.value = look.width * roevo.uniforms.pixel.value; };
    mesh.userData = {positions, paint};
    mesh.visible = false;
    return mesh;
};

// look: {size (m), darkest}
roevo.points = function (positions, colours, look) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute('colour', new THREE.BufferAttribute(colours, 4, true));
    const points = new THREE.Points(geometry, roevo.material(kPointShader, {
        size: {value: look.size}, darkest: {value: look.darkest || 0}}));
    points.frustumCulled = false;
    points.userData = {positions};
    points.visible = false;
    return points;
};

// The same colour for all points of a line that is given in strokes of equal length.
roevo.evenColours = function (count, colour, stroke) {
    const colours = new Uint8Array(4 * count);
    for (let i = 0; i < count; ++i) colours.set([...colour, i % stroke === 0 ? 0 : 255], 4 * i);
    return colours;
};

roevo.rgb = hex => [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16));

// ---- cameras

const kStroke = [-1, 0, 1, -1, 2, 3, -1, 3, 0, 1, 2];  // along every edge of the pyramid; -1: the apex

// Pyramids of view for some of the poses, as one line in strokes.
roevo.frusta = function (poses, which, corners, depth) {
    const positions = new Float32Array(3 * kStroke.length * which.length);
    const rotation = new THREE.Quaternion(), apex = new THREE.Vector3(), corner = new THREE.Vector3();
    which.forEach((i, n) => {
        rotation.fromArray(poses.rotations, 4 * i);
        apex.fromArray(poses.positions, 3 * i);
        kStroke.forEach((k, m) => {
            if (k < 0) corner.copy(apex);
            else corner.fromArray(corners[k]).multiplyScalar(depth).applyQuaternion(rotation).add(apex);
            corner.toArray(positions, 3 * (kStroke.length * n + m));
        });
    });
    return positions;
};
roevo.strokeLength = kStroke.length;

// ---- what there is to see: boxes, views

// The value below which the share of the values lies.
roevo.quantile = function (values, share) {
    const sorted = Float32Array.from(values).sort();
    return sorted[Math.floor(share * (sorted.length - 1))];
};

// At most so many of the points of several lists, evenly.
roevo.sample = function (lists, most) {
    const count = lists.reduce((sum, list) => sum + list.length / 3, 0), step = Math.max(1, Math.ceil(count / most));
    const sample = [];
    for (const list of lists)
        for (let i = 0; i + 2 < list.length; i += 3 * step) sample.push([list[i], list[i + 1], list[i + 2]]);
    return sample;
};

// Without points that lie far off: wrong depths, and what is seen through a window.
roevo.withoutOutliers = function (points) {
    if (points.length === 0) return points;
    const middle = [0, 1, 2].map(axis => roevo.quantile(points.map(p => p[axis]), 0.5));
    const distance = p => Math.hypot(p[0] - middle[0], p[1] - middle[1], p[2] - middle[2]);
    const reach = 3 * roevo.quantile(points.map(distance), 0.9);  // real maps reach up to 2.8 times as far
    return points.filter(p => distance(p) <= reach);
};

// Where to stand to have all points in the picture, looking along a direction: {position, target}. tangents: of half
// the picture's width and height.
roevo.standpoint = function (points, direction, up, tangents) {
    const forward = new THREE.Vector3(...direction).normalize();
    const right = new THREE.Vector3().crossVectors(forward, new THREE.Vector3(...up)).normalize();
    const down = new THREE.Vector3().crossVectors(forward, right);
    const lowest = n => points.reduce((low, p) => Math.min(low, n.x * p[0] + n.y * p[1] + n.z * p[2]), Infinity);
    // A point is inside the picture's left border when x + z t >= cx + cz t, with (cx, cy, cz) the camera in the axes
    // right, down, forward; likewise on the other sides. Two opposite borders that touch the points give cx and cz.
    const touch = (axis, t) => {
        const a = lowest(axis.clone().addScaledVector(forward, t));
        const b = -lowest(axis.clone().negate().addScaledVector(forward, t));
        return {middle: (a + b) / 2, back: (a - b) / (2 * t)};
    };
    const x = touch(right, tangents[0]), y = touch(down, tangents[1]), z = Math.min(x.back, y.back);
    const at = depth => new THREE.Vector3().addScaledVector(right, x.middle).addScaledVector(down, y.middle)
        .addScaledVector(forward, depth);
    const depth = (lowest(forward) - lowest(forward.clone().negate())) / 2;
    return {position: at(z), target: at(Math.max(depth, z + 0.1))};
};

// 1, 2 or 5 times a power of ten, the largest that is not above the length.
roevo.roundLength = function (length) {
    const power = Math.pow(10, Math.floor(Math.log10(length)));
    return power * [5, 2, 1].find(n => n * power <= length * 1.000001);
};

// Lengths are in m and errors in cm, as in all that the programs print.
roevo.lengthText = metres => Number(metres.toPrecision(3)) + ' m';
roevo.errorText = metres => Number((100 * metres).toPrecision(3)) + ' cm';

// Lines on the ground under the points, and the size of their cells.
roevo.grid = function (points) {
    const range = axis => [0.02, 0.98].map(share => roevo.quantile(points.map(p => p[axis]), share));
    const [x, y, z] = [0, 1, 2].map(range), cell = roevo.roundLength(Math.max(x[1] - x[0], y[1] - y[0], 0.1) / 5);
    const low = v => Math.floor(v / cell) * cell, high = v => Math.ceil(v / cell) * cell;
    const positions = [];
    for (let u = low(x[0]); u <= high(x[1]) + cell / 2; u += cell) positions.push(u, low(y[0]), z[0], u, high(y[1]), z[0]);
    for (let v = low(y[0]); v <= high(y[1]) + cell / 2; v += cell) positions.push(low(x[0]), v, z[0], high(x[1]), v, z[0]);
    return {positions: new Float32Array(positions), cell};
};

// ---- errors as colours

const kRamp = ['#3f7fff', '#2fd0c8', '#f4e04d', '#ff9636', '#ff3b3b'].map(roevo.rgb);
roevo.unknownColour = [120, 128, 140];

// share: 0..1, NaN for an unknown error
roevo.rampColour = function (share) {
    if (!(share >= 0)) return roevo.unknownColour;
    const at = Math.min(share, 1) * (kRamp.length - 1), k = Math.min(Math.floor(at), kRamp.length - 2);
    return kRamp[k].map((c, i) => Math.round(c + (at - k) * (kRamp[k + 1][i] - c)));
};
