// What browsers tell assistive technology about the elements of a page.
import { inFirefox } from "./suite.mjs";

const kControls = "button, input, select, option, textarea, dialog, [role]";

/** The controls with these roles that assistive technology can reach, as objects {role, name}. */
export async function controlsOf(page, roles) {
    if (inFirefox) return (await page.accessible(kControls)).filter((one) => roles.includes(one?.role));
    const session = await page.context().newCDPSession(page);
    const { nodes } = await session.send("Accessibility.getFullAXTree");
    await session.detach();
    const controls = nodes.filter(({ ignored, role }) => !ignored && roles.includes(role?.value));
    return controls.map(({ role, name }) => ({ role: role.value, name: name?.value ?? "" }));
}

/**
 * The accessible names of all matching elements, in document order. Undefined for an element that assistive technology
 * cannot reach.
 */
export async function namesOf(page, selector) {
    if (inFirefox) return (await page.accessible(selector)).map((one) => one?.name);
    const session = await page.context().newCDPSession(page);
    const { root } = await session.send("DOM.getDocument");
    const { nodeIds } = await session.send("DOM.querySelectorAll", { nodeId: root.nodeId, selector });
    const names = [];
    for (const nodeId of nodeIds) {
        const { nodes } = await session.send("Accessibility.getPartialAXTree", { nodeId, fetchRelatives: false });
        const [{ ignored, name }] = nodes;
        names.push(ignored ? undefined : (name?.value ?? ""));
    }
    await session.detach();
    return names;
}
