// The commands of the command line that the page executes itself.

export interface PageCommands {
    /** Opens the help, or shows what it says about a topic. */
    help(topic: string): void;
    /** Saves a file that a format and options describe, such as "stl fit=5", or opens the export dialog for "". */
    exportFile(description: string): Promise<void> | undefined | void;
}

/** Executes a line; returns false if it is not a command of the page. */
export async function executePageCommand(line: string, commands: PageCommands): Promise<boolean> {
    const [, name = "", argument = ""] = /^(\S+)\s*(.*)$/s.exec(line.trim()) ?? [];
    if (name === "help") commands.help(argument);
    else if (name === "export") await commands.exportFile(argument);
    else return false;
    return true;
}
