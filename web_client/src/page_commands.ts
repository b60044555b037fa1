// The commands of the command line that the page executes itself, without the server.

export interface PageCommands {
    /** Opens the help. If the topic is not "", shows only the lines that mention it. */
    help(topic: string): void;
    /**
     * Exports a file. `description` is a format with options, such as "stl fit=5"; if it is "", the export dialog
     * opens.
     */
    exportFile(description: string): Promise<void>;
    /** Shows the link to the session as a QR code. */
    share(): void;
}

/** Executes a line if it is a command of the page. Returns false for any other line. */
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
