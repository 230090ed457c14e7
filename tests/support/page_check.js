// Run inside a page of `deflect … --report` by page.h: uses it as a person does and writes down what happened.
(() => {
  const failures = [], blobs = [], saved = [];
  addEventListener('error', (e) => failures.push(String(e.message)));
  addEventListener('unhandledrejection', (e) => failures.push(String(e.reason)));
  addEventListener('securitypolicyviolation', (e) => failures.push('blocked: ' + e.blockedURI));
  for (const kind of ['error', 'warn']) console[kind] = (...words) => failures.push(kind + ': ' + words.join(' '));
  // Nothing may be waited for but timers: what is saved is seen where it is made.
  const RealBlob = Blob;
  window.Blob = function (parts, options) {
    blobs.push(parts.join(''));
    return new RealBlob(parts, options);
  };
  HTMLAnchorElement.prototype.click = function () {
    saved.push({name: this.href.startsWith('blob:') && this.download, text: blobs[blobs.length - 1]});
  };

  // In virtual time frames come too rarely: they are made of it.
  window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 16);
  const frame = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 20)));
  const settle = async () => { for (let i = 0; i < 4; ++i) await frame(); };
  const painted = (canvas) => {
    const copy = document.createElement('canvas');
    copy.width = canvas.width;
    copy.height = canvas.height;
    const pen = copy.getContext('2d');
    pen.drawImage(canvas, 0, 0);
    const {data} = pen.getImageData(0, 0, copy.width, copy.height);
    const seen = new Set();
    let hash = 0;
    for (let i = 0; i < data.length; i += 4) {
      const pixel = (data[i] << 16) | (data[i + 1] << 8) | data[i + 2] | (data[i + 3] << 24);
      seen.add(pixel);
      hash = (Math.imul(hash, 31) + pixel) | 0;
    }
    return {colours: seen.size, hash};
  };
  const set = (input, value, event) => {
    input.value = String(value);
    input.dispatchEvent(new Event(event, {bubbles: true}));
  };
  const drag = (canvas) => {
    const send = (target, type, x) => target.dispatchEvent(new MouseEvent(type, {clientX: x, clientY: 300, button: 0, bubbles: true, cancelable: true}));
    send(canvas, 'mousedown', 200);
    send(document, 'mousemove', 320);
    send(document, 'mouseup', 320);
  };

  addEventListener('load', async () => {
    const report = {};
    try {
      for (let i = 0; i < 200 && !document.documentElement.dataset.ready; ++i) await frame();
      await settle();
      const text = (id) => document.getElementById(id)?.textContent ?? '';
      report.verdict = text('verdict');
      report.ids = text('verdict-ids');
      report.legend = document.querySelector('#machine .legend')?.textContent ?? '';
      report.title = text('subject');
      report.missing = [...document.querySelectorAll('.missing')].map((each) => each.textContent);
      report.scale = document.querySelector('.scale')?.textContent ?? '';
      report.factor = document.querySelector('.factor')?.textContent ?? '';
      // Words that are wider than their place or stand beyond the window; tables are scrolled sideways, their names not.
      report.cut = [...document.querySelectorAll('h1, h2, h3, p, li, dt, dd, label, summary, .legend div, tbody th')].filter((each) => {
        const shown = each.getClientRects().length > 0 && getComputedStyle(each).overflow !== 'auto';
        return shown && (each.scrollWidth > each.clientWidth + 1 && getComputedStyle(each).display !== 'inline' || each.getBoundingClientRect().right > innerWidth + 0.5);
      }).map((each) => each.textContent.slice(0, 80));
      report.from = [...document.querySelectorAll('.from')].map((each) => each.textContent);
      report.scripts = document.querySelectorAll('script').length;
      report.wide = document.documentElement.scrollWidth > innerWidth;
      report.charts = [...document.querySelectorAll('.chart canvas')].map((c) => ({about: c.getAttribute('aria-label'), drawn: Number(c.dataset.drawn || 0), colours: painted(c).colours}));
      report.views = [...document.querySelectorAll('.view canvas, .maps canvas')].map((c) => painted(c).colours);
      const view = document.querySelector('#machine-view canvas');
      if (view) {
        const step = async (name, act) => {
          const before = painted(view).hash;
          act();
          await settle();
          report[name] = painted(view).hash !== before;
        };
        await step('still', () => {});
        await step('dragged', () => drag(view));
        await step('turned', () => document.querySelector('#machine-view .buttons button').click());
        const slider = document.getElementById('pose-slider');
        if (slider) {
          const words = document.getElementById('machine-readout').textContent;
          await step('posed', () => set(slider, slider.value === slider.max ? 0 : slider.max, 'input'));
          report.readout = document.getElementById('machine-readout').textContent !== words;
        }
        const scale = document.getElementById('scale-slider');
        if (scale) await step('deflected', () => set(scale, 0, 'input'));
      }
      const notes = (canvas) => {
        const r = canvas.getBoundingClientRect(), seen = new Set();
        for (let x = 0.1; x < 0.95; x += 0.02)
          for (let y = 0.1; y < 0.95; y += 0.02) {
            canvas.dispatchEvent(new PointerEvent('pointermove', {clientX: r.left + x * r.width, clientY: r.top + y * r.height}));
            const tip = document.querySelector('.tip');
            if (tip && !tip.hidden) seen.add(tip.textContent);
          }
        return [...seen];
      };
      report.notes = [...document.querySelectorAll('.view canvas, .maps canvas')].map(notes);
      report.background = getComputedStyle(document.body).backgroundColor;
      for (const event of ['beforeprint', 'afterprint']) dispatchEvent(new Event(event));
      await settle();
      for (const details of document.querySelectorAll('details')) details.open = true;
      await settle();
      report.tables = [...document.querySelectorAll('section')].map((s) => ({id: s.id, rows: s.querySelectorAll('tbody tr').length}));
      for (const button of document.querySelectorAll('button.csv')) button.click();
      report.saved = {};
      for (const {name, text} of saved) report.saved[name] = text;
      report.text = document.getElementById('page').textContent.length;
    } catch (error) {
      failures.push(String(error.stack));
    }
    report.failures = failures;
    const done = document.createElement('pre');
    done.id = 'checked';
    done.textContent = '@@' + btoa(unescape(encodeURIComponent(JSON.stringify(report)))) + '@@';
    document.body.replaceChildren(done);
  });
})();
