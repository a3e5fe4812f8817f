'use strict';
// The page: reads the data, fills the panel, draws when something has changed.
(function () {
    const byId = id => document.getElementById(id);
    const data = JSON.parse(byId('data').textContent);
    const kColours = {final: '#ff7a4d', live: '#ffd45e', truth: '#4fd98b', keyframes: '#5b9dff'};
    const kOtherColours = ['#6fd3ff', '#e58cf2', '#c3d36a', '#ff9fb8', '#b9a7ff', '#e0b08a', '#4fe0c0', '#9fb3c8'];
    const kFieldOfView = 40, kNarrow = 640;  // degrees, px

    // ---- what is shown

    const scene = new THREE.Scene();
    const items = [];  // {id, title, object, swatch, figure, list, shown}
    const add = item => {
        scene.add(item.object);
        items.push(item);
        return item;
    };

    const paths = data.paths.map((path, i) => {
        const others = data.paths.slice(0, i).filter(p => p.role === 'other').length;
        const colour = path.role === 'other' ? kOtherColours[others % kOtherColours.length] : kColours[path.role];
        const poses = {
            count: path.count, positions: roevo.floats(path.positions), rotations: roevo.floats(path.rotations)
        };
        return Object.assign(poses, {
            name: path.name, colour: roevo.rgb(colour), times: roevo.floats(path.times),
            errors: path.errors === null ? null : roevo.floats(path.errors),
            item: add({
                id: path.role === 'other' ? 'other' + (others + 1) : path.role, title: path.name, swatch: colour,
                list: 'path-list', shown: path.role !== 'live',
                figure: path.ate === null ? '' : 'ATE ' + roevo.errorText(path.ate),
                object: roevo.lines(poses.positions, roevo.evenColours(poses.count, roevo.rgb(colour), poses.count),
                                    {width: path.role === 'final' ? 2.6 : 2})
            })
        });
    });
    const layers = data.layers.filter(layer => layer.count > 0).map(layer => {
        const positions = roevo.positions(layer), colours = roevo.bytes(layer.colours);
        add({
            id: layer.id, title: layer.title, list: 'layer-list', shown: layer.shown,
            figure: layer.count.toLocaleString('en') + ' points',
            object: layer.lines ? roevo.lines(positions, colours, {width: 1.6, darkest: 0.5})
                                : roevo.points(positions, colours, {size: 0.014, darkest: 0.15})
        });
        return positions;
    });

    const walked = roevo.sample(paths.map(path => path.positions), 5000);
    const content = roevo.withoutOutliers(roevo.sample(layers.slice(0, 1), 15000)).concat(walked);
    const size = [0, 1, 2].map(axis => {
        const values = content.map(p => p[axis]);
        return roevo.quantile(values, 0.98) - roevo.quantile(values, 0.02);
    });
    const extent = Math.max(Math.hypot(...size), 0.1);

    const frustumDepth = Math.min(Math.max(0.03 * extent, 0.03), 0.3);
    let marker = null;
    if (data.corners !== null) {
        const poses = {
            positions: roevo.floats(data.keyframes.positions), rotations: roevo.floats(data.keyframes.rotations)
        };
        const all = [...Array(data.keyframes.count).keys()];
        if (all.length > 0) {
            const frusta = roevo.frusta(poses, all, data.corners, frustumDepth);
            add({
                id: 'keyframes', title: 'keyframes', list: 'layer-list', shown: true, swatch: kColours.keyframes,
                figure: String(all.length),
                object: roevo.lines(frusta, roevo.evenColours(frusta.length / 3, roevo.rgb(kColours.keyframes),
                                                              roevo.strokeLength), {width: 1.3})
            });
        }
    }
    const grid = roevo.grid(content);
    add({
        id: 'grid', title: 'ground grid', list: 'layer-list', shown: true,
        figure: 'cells of ' + roevo.lengthText(grid.cell),
        object: roevo.lines(grid.positions, roevo.evenColours(grid.positions.length / 3, [58, 68, 84], 2), {width: 1})
    });
    const framed = content.concat(roevo.sample([grid.positions], 5000));

    paths.forEach((path, i) => {  // where they lie on one another the first in the list is seen
        path.item.object.material.polygonOffset = true;
        path.item.object.material.polygonOffsetUnits = 40 * (i - paths.length);
    });

    // ---- drawing

    const canvas = byId('canvas');
    let renderer;
    try {
        renderer = new THREE.WebGLRenderer({canvas, antialias: true});
    } catch (fault) {
        byId('fault').hidden = false;
        byId('fault').textContent = 'This browser gives no WebGL, which the view is drawn with: ' + fault.message;
        return;
    }
    renderer.setClearColor(new THREE.Color(...roevo.background.map(c => c / 255)));
    const camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.003 * extent, 60 * extent);
    camera.up.set(0, 0, 1);
    roevo.uniforms.near.value = camera.near;
    const controls = new THREE.OrbitControls(camera, canvas);
    controls.screenSpacePanning = true;
    controls.minDistance = 0.02 * extent;
    controls.maxDistance = 20 * extent;

    let pending = false, touched = false;
    function draw() {
        pending = false;
        renderer.render(scene, camera);
        showRuler();
    }
    function changed() {
        if (!pending) requestAnimationFrame(draw);
        pending = true;
    }
    controls.addEventListener('change', changed);
    controls.addEventListener('start', () => { touched = true; });

    // The part of the window that the panel leaves free: px.
    function freeArea() {
        const wide = innerWidth > kNarrow, open = byId('panel').open;
        return {
            left: wide && open ? 292 : 0, top: wide ? 20 : 60,
            right: innerWidth, bottom: innerHeight - (wide ? 60 : 100)
        };
    }

    function resize() {
        const area = freeArea(), ratio = Math.min(devicePixelRatio, 2);
        renderer.setPixelRatio(ratio);
        renderer.setSize(innerWidth, innerHeight, false);
        roevo.uniforms.viewport.value.set(innerWidth * ratio, innerHeight * ratio);
        roevo.uniforms.pixel.value = ratio;
        camera.aspect = innerWidth / innerHeight;
        // The middle of the free area is the middle of the picture
        camera.setViewOffset(innerWidth, innerHeight, (innerWidth - area.left - area.right) / 2,
                             (innerHeight - area.top - area.bottom) / 2, innerWidth, innerHeight);
        if (!touched) look(viewName);
        changed();
    }

    const kViews = {  // looking along, as roevo-render's pictures do
        iso: [[0.646, 0.452, -0.616], [0, 0, 1]],
        top: [[0.001, 0, -1], [0, 0, 1]],
        front: [[0.996, 0, -0.087], [0, 0, 1]]
    };
    let viewName = 'iso';
    function look(name) {
        viewName = name;
        const area = freeArea(), tangent = 0.94 * Math.tan(kFieldOfView * Math.PI / 360) / innerHeight;
        const place = roevo.standpoint(framed, ...kViews[name],
                                       [tangent * (area.right - area.left), tangent * (area.bottom - area.top)]);
        camera.position.copy(place.position);
        controls.target.copy(place.target);
        controls.update();
        changed();
    }

    function showRuler() {
        const distance = camera.position.distanceTo(controls.target);
        const pixelsPerMetre = innerHeight / (2 * Math.tan(kFieldOfView * Math.PI / 360) * distance);
        const length = roevo.roundLength(150 / pixelsPerMetre);
        byId('ruler').style.width = (length * pixelsPerMetre).toFixed(1) + 'px';
        byId('ruler').firstChild.textContent = roevo.lengthText(length);
    }

    // ---- colours of the trajectories

    let byError = false;
    function paintPaths() {
        let most = 0;
        for (const path of paths)
            if (path.errors && path.item.object.visible)
                most = path.errors.reduce((a, b) => b > a ? b : a, most);
        for (const path of paths) {
            const paint = path.item.object.userData.paint;
            for (let i = 0; i < path.count; ++i)
                paint.array.set(!byError ? path.colour :
                                roevo.rampColour(!path.errors ? NaN : most > 0 ? path.errors[i] / most : 0), 4 * i);
            paint.needsUpdate = true;
        }
        byId('scale').hidden = !byError;
        byId('middle').textContent = roevo.errorText(most / 2);
        byId('most').textContent = roevo.errorText(most);
        changed();
    }

    function drawRamp() {
        const ramp = byId('ramp').getContext('2d');
        for (let x = 0; x < 256; ++x) {
            ramp.fillStyle = 'rgb(' + roevo.rampColour(x / 255) + ')';
            ramp.fillRect(x, 0, 1, 1);
        }
    }

    // ---- panel

    function show(item, shown) {
        item.object.visible = shown;
        item.box.checked = shown;
    }

    function fillPanel() {
        byId('title').textContent = data.title;
        byId('facts').textContent = data.facts.join(' · ');
        for (const item of items) {
            const label = document.createElement('label'), parts = {};
            item.box = label.appendChild(document.createElement('input'));
            item.box.type = 'checkbox';
            item.box.dataset.item = item.id;
            for (const part of ['swatch', 'name', 'figure']) {
                parts[part] = label.appendChild(document.createElement('span'));
                parts[part].className = part;
            }
            if (item.swatch) parts.swatch.style.background = item.swatch;
            else parts.swatch.remove();
            parts.name.textContent = item.title;
            parts.figure.textContent = item.figure;
            byId(item.list).appendChild(label);
            show(item, item.shown);
            item.box.addEventListener('change', () => {
                item.object.visible = item.box.checked;
                paintPaths();
            });
        }
        for (const note of data.notes) byId('notes').appendChild(document.createElement('li')).textContent = note;
        byId('colouring').hidden = !paths.some(path => path.errors);
        byId('colouring').addEventListener('change', event => {
            byError = event.target.value === 'error';
            paintPaths();
        });
        byId('panel').addEventListener('toggle', resize);
        for (const button of byId('views').children)
            button.addEventListener('click', () => look(button.dataset.view));
    }

    // ---- one moment of the trajectory

    function momentText(path, i) {
        const error = path.errors ? path.errors[i] : NaN;
        return path.times[i].toFixed(2) + ' s' + (error >= 0 ? ' · error ' + roevo.errorText(error) : '');
    }

    function showMoment(i) {
        byId('time-slider').value = i;
        byId('time-text').textContent = momentText(paths[0], i);
        if (data.corners === null) return;
        const positions = roevo.frusta(paths[0], [i], data.corners, 1.8 * frustumDepth);
        if (marker === null) {
            const white = roevo.evenColours(roevo.strokeLength, [255, 255, 255], roevo.strokeLength);
            marker = roevo.lines(positions, white, {width: 2});
            scene.add(marker);
        }
        marker.visible = true;
        const buffer = marker.geometry.attributes.from.data;
        buffer.array.set(positions);
        buffer.needsUpdate = true;
        changed();
    }

    // ---- pointing

    // Calls visit(i, distance in px, depth) for the points of a list that are before the camera.
    function project(positions, x, y, visit) {
        const m = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
        for (let i = 0; i + 2 < positions.length; i += 3) {
            const p = positions[i], q = positions[i + 1], r = positions[i + 2];
            const w = m[3] * p + m[7] * q + m[11] * r + m[15];
            if (w <= camera.near) continue;
            const u = (m[0] * p + m[4] * q + m[8] * r + m[12]) / w, v = (m[1] * p + m[5] * q + m[9] * r + m[13]) / w;
            visit(i / 3, Math.hypot((u + 1) / 2 * innerWidth - x, (1 - v) / 2 * innerHeight - y), w);
        }
    }

    function showTip(event) {
        let found = null, nearest = 12;  // px
        if (event.buttons === 0)
            for (const path of paths)
                if (path.item.object.visible)
                    project(path.positions, event.clientX, event.clientY, (i, distance) => {
                        if (distance < nearest) [found, nearest] = [{path, i}, distance];
                    });
        const tip = byId('tip');
        tip.hidden = found === null;
        if (found === null) return;
        tip.textContent = found.path.name + ': ' + momentText(found.path, found.i);
        tip.style.left = Math.max(0, Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8)) + 'px';
        tip.style.top = Math.max(0, event.clientY - tip.offsetHeight - 10) + 'px';
    }

    function turnAround(event) {
        let found = null, nearest = Infinity;
        for (const item of items)
            if (item.object.visible && item.id !== 'grid')
                project(item.object.userData.positions, event.clientX, event.clientY, (i, distance, depth) => {
                    if (distance < 14 && depth < nearest)
                        [found, nearest] = [[item.object.userData.positions, 3 * i], depth];
                });
        if (found === null) return;
        touched = true;
        controls.target.fromArray(...found);
        controls.update();
        changed();
    }

    // ---- what the address asks for: #view=top&hide=edges,grid&show=surface&colour=error&frame=100

    function obeyAddress() {
        const wishes = new URLSearchParams(location.hash.slice(1));
        for (const [key, shown] of [['hide', false], ['show', true]])
            for (const id of (wishes.get(key) || '').split(','))
                items.filter(item => item.id === id).forEach(item => show(item, shown));
        if (Object.keys(kViews).includes(wishes.get('view'))) look(wishes.get('view'));
        if (wishes.get('colour') === 'error' && !byId('colouring').hidden) {
            document.querySelector('input[value=error]').checked = true;
            byError = true;
        }
        paintPaths();
        if (wishes.get('frame') !== null) {
            const i = Math.round(Number(wishes.get('frame')));
            if (i >= 0 && i < paths[0].count) showMoment(i);
        }
    }

    drawRamp();
    if (innerWidth <= kNarrow) byId('panel').open = false;
    fillPanel();
    const slider = byId('time-slider');
    slider.max = paths[0].count - 1;
    slider.addEventListener('input', () => showMoment(Number(slider.value)));
    byId('time-text').textContent = momentText(paths[0], 0);
    canvas.addEventListener('pointermove', showTip);
    canvas.addEventListener('pointerleave', () => { byId('tip').hidden = true; });
    canvas.addEventListener('dblclick', turnAround);
    addEventListener('resize', resize);
    addEventListener('hashchange', obeyAddress);
    resize();
    obeyAddress();
})();
