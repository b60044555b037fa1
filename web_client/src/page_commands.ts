// The commands of the command line that the page executes itself.

export interface PageCommands {
    /** Opens the help. If the topic is not "", shows only the lines that mention it. */
    help(topic: string): void;
    /** Saves the file that a format and options describe, such as "stl fit=5". For "", opens the export dialog. */
    exportFile(description: string): Promise<void>;
    /** Shows the link to the session as a QR code. */
    share(): void;
}

/** Executes a line; returns false if it is not a command of the page. */
export async function executePageCommand(line: string, commands: PageCommands): Promise<boolean> {
    const [, name = "", argument = ""] = /^(\S+)\s*(.*)$/s.exec(line.trim()) ?? [];
    if (name === "help") commands.help(argument);
    else if (name === "export") await commands.exportFile(argument);
    else if (name === "share") {
        if (argument !== "") throw new Error(`this command takes no arguments; remove “${argument}”`);
        commands.share();
    } else return false;
    return true;
}
