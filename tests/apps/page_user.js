// Put at the end of a page of roevo-render by test_render_browser.cpp: uses it as a user would, and counts pixels
// after each step.
(async function () {
    const canvas = document.getElementById('canvas'), flat = document.createElement('canvas');
    const found = {};
    // The page draws in the animation frame that an event asks for; ours comes after it in the same one
    const pixels = () => new Promise(done => {
        dispatchEvent(new Event('resize'));
        requestAnimationFrame(() => {
            [flat.width, flat.height] = [canvas.width, canvas.height];
            const context = flat.getContext('2d');
            context.drawImage(canvas, 0, 0);
            done(context.getImageData(0, 0, flat.width, flat.height).data);
        });
    });
    const count = (data, is) => {
        let n = 0;
        for (let i = 0; i < data.length; i += 4) n += is(data[i], data[i + 1], data[i + 2]);
        return n;
    };
    const magenta = (r, g, b) => r > 110 && b > 110 && g < 0.6 * r, green = (r, g, b) => g > 150 && r < 90 && b < 90;
    const orange = (r, g, b) => r > 180 && g > 0.38 * r && g < 0.6 * r && b < 0.5 * r;
    const box = id => document.querySelector('input[data-item="' + id + '"]');
    const differing = (a, b) => count(a.map((v, i) => Math.abs(v - b[i])), (r, g, b) => r + g + b > 60);
    const mouse = (type, x, y, target) => target.dispatchEvent(new MouseEvent(type, {clientX: x, clientY: y, button: 0, bubbles: true}));
    const touch = (type, x, y) => canvas.dispatchEvent(new TouchEvent(type, {bubbles: true, cancelable: true,
        touches: [new Touch({identifier: 1, target: canvas, clientX: x, clientY: y, pageX: x, pageY: y})]}));

    let now = await pixels();
    found.edges = count(now, magenta);
    found.path = count(now, orange);
    found.behind = count(now, green);
    box('edges').click();
    found.hidden = count(await pixels(), magenta);
    box('edges').click();
    found.shown = count(await pixels(), magenta);
    document.querySelector('input[value=error]').click();
    found.path_by_error = count(await pixels(), orange);
    document.querySelector('input[value=name]').click();

    mouse('mousedown', 500, 300, canvas), mouse('mousemove', 560, 330, document), mouse('mouseup', 560, 330, document);
    let before = now;
    now = await pixels();
    found.turned = differing(before, now);
    canvas.dispatchEvent(new WheelEvent('wheel', {deltaY: -300, bubbles: true, cancelable: true}));
    before = now;
    now = await pixels();
    found.zoomed = differing(before, now);
    touch('touchstart', 500, 300), touch('touchmove', 400, 300), touch('touchend', 400, 300);
    before = now;
    now = await pixels();
    found.touched = differing(before, now);
    box('live').focus();
    const slider = document.getElementById('time-slider');
    slider.value = 30;
    slider.dispatchEvent(new Event('input'));
    found.moment = document.getElementById('time-text').textContent;
    found.names = [...document.querySelectorAll('#path-list .name')].map(e => e.textContent);
    found.loaded = performance.getEntriesByType('resource').length;
    found.overflow = document.documentElement.scrollWidth - innerWidth;
    tell(found);
})();
