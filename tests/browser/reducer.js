// Random actions on the reducer alone, with answers of the server late, twice, or to questions that nobody asks any more.
actions => { let seed = 7; const random = n => (seed = (seed * 1103515245 + 12345) % 2147483648) % n;
        const problems = [], base = studio.state.ask; let opened = 0, closed = 0;
        for (let run = 0; run < 40; run++) {
            let state = {...studio.state, phase: 'idle', live: null, problem: null, kept: null, shown: null, room: ''};
            let streams = 0;
            for (let n = 0; n < actions; n++) {
                const job = state.job - random(2), shown = {id: 'r' + n, of: 'generated', ask: state.ask, name: 'x', radar: state.ask.radar, facts: ''};
                const problem = {code: 'input', reason: '', ways: [], of: 'making'};
                const live = {frames: n, times: 1, text: 'a person claps', refused: random(4) ? '' : 'no', ways: [], label: null};
                const all = [{type: 'edit', change: {seed: random(9)}}, {type: 'edit', change: {radar: random(2) ? 'awr1843' : 'iwr6843isk'}}, {type: 'go'}, {type: 'generate'}, {type: 'live'}, {type: 'stop'},
                    {type: 'type', person: 0, text: 's' + n}, {type: 'people', change: random(2) ? 'add' : 'remove', person: 0}, {type: 'dismiss'}, {type: 'place', at: [0, n], note: ''},
                    {type: 'keep', on: random(2) === 1}, {type: 'open', recording: 'r'}, {type: 'room', job, room: state.ask.room + ' ' + state.ask.radar + ' '}, {type: 'made', job, shown},
                    {type: 'opened', job, shown: {...shown, of: 'recording', ask: null}, hasRoom: false}, {type: 'chunk', job, live, radar: state.ask.radar}, {type: 'failed', job, problem}, {type: 'closed', job}];
                const action = all[random(all.length)], before = state;
                if ((action.type === 'made' && before.phase !== 'making') || (action.type === 'opened' && before.phase !== 'opening') || (['chunk', 'closed'].includes(action.type) && before.phase !== 'live')) continue;
                const [next, effects] = studio.reduce(before, action);
                for (const effect of effects) { if (effect.do === 'stream') streams++; if (effect.do === 'end-stream') streams--; }
                if (action.type === 'closed' && next !== before) streams--;
                const fails = (what, is) => { if (is) problems.push(what + ' after ' + action.type + ' in ' + before.phase); };
                fails('an old answer counts', 'job' in action && action.job !== before.job && next !== before);
                fails('streams ' + streams, streams !== (next.phase === 'live' ? 1 : 0));
                fails('a job goes on unasked', effects.some(e => ['make', 'stream', 'open'].includes(e.do)) && next.job === before.job);
                fails('live facts outside live', next.live !== null && next.phase !== 'live');
                fails('A is a stream', next.kept && next.kept.of === 'stream');
                fails('nobody is asked for', next.ask.people.length < 1);
                state = next;
            }
        }
        return problems.slice(0, 5); }
