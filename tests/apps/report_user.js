// In a page beside a report, for test_compare_browser.cpp: opens the report and its 3-D views in frames as wide as
// screens are, and tells what a user would see of them.
(async function () {
    const frameOf = (address, width) => new Promise(done => {
        const frame = document.createElement('iframe');
        frame.style = 'border: 0; height: 700px; width: ' + width + 'px';
        frame.onload = () => done(frame.contentWindow);
        frame.src = address;
        document.body.append(frame);
    });
    const named = e => e.tagName + '.' + (e.getAttribute('class') || '') + ' ' + e.textContent.slice(0, 40);
    // Of what can be scrolled sideways by itself, that alone has to fit
    const inScroller = e => e.parentElement && (/auto|scroll/.test(getComputedStyle(e.parentElement).overflowX) || inScroller(e.parentElement));
    const spills = e => getComputedStyle(e).overflowX == 'visible' && e.clientWidth > 0 && e.scrollWidth > e.clientWidth && e.getBoundingClientRect().left + e.scrollWidth > e.ownerDocument.documentElement.clientWidth + 0.5;
    const leaves = (inner, outer) => inner.width > 0 && (inner.left < outer.left - 1 || inner.right > outer.right + 1 || inner.top < outer.top - 1 || inner.bottom > outer.bottom + 1);
    const report = page => {
        const root = page.document.documentElement, texts = [...page.document.querySelectorAll('.plot text')];
        const box = e => e.getBoundingClientRect(), plot = e => e.closest('.plot');
        return {
            overflow: root.scrollWidth - root.clientWidth,
            beyond: [...page.document.querySelectorAll('body *')].filter(e => !e.closest('svg *') && !inScroller(e) && (box(e).right > root.clientWidth + 0.5 || box(e).left < -0.5 || spills(e))).map(named),
            hidden: [...page.document.querySelectorAll('body *')].filter(e => getComputedStyle(e).overflowX == 'hidden' && e.scrollWidth > e.clientWidth && !e.closest('svg')).map(named),
            cut: texts.filter(e => leaves(box(e), box(plot(e)))).map(named),
            smallest: Math.min(...texts.map(e => parseFloat(getComputedStyle(e).fontSize) * box(plot(e)).width / plot(e).viewBox.baseVal.width)),
            plots: page.document.querySelectorAll('.plot').length,
            views: [...page.document.querySelectorAll('.view a')].map(a => a.href),
            files: [...page.document.querySelectorAll('figcaption a')].map(a => decodeURIComponent(a.href)),
            loaded: page.performance.getEntriesByType('resource').map(e => e.name),
        };
    };
    // Pixels that are not as the corner is, drawn in the animation frame that an event asks for
    const drawn = page => new Promise(done => {
        page.dispatchEvent(new Event('resize'));
        page.requestAnimationFrame(() => {
            const canvas = page.document.getElementById('canvas'), flat = document.createElement('canvas');
            [flat.width, flat.height] = [canvas.width, canvas.height];
            const context = flat.getContext('2d');
            context.drawImage(canvas, 0, 0);
            const data = context.getImageData(0, 0, flat.width, flat.height).data;
            let n = 0;
            for (let i = 0; i < data.length; i += 4) n += Math.abs(data[i] - data[0]) + Math.abs(data[i + 1] - data[1]) + Math.abs(data[i + 2] - data[2]) > 60;
            done(n);
        });
    });
    const found = {};
    for (const width of [1280, 800, 390]) {
        const of = found[width] = report(await frameOf(report_address, width));
        if (of.views.length == 0) continue;
        const view = await frameOf(of.views[0], width);
        of.webgl = view.document.getElementById('fault').hidden;
        of.view_overflow = view.document.documentElement.scrollWidth - width;
        if (of.webgl) of.drawn = await drawn(view);
    }
    tell(found);
})().catch(fault => tell({fault: String(fault)}));
