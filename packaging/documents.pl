#!/usr/bin/env perl
# packaging/documents.pl TARGET: README.md and the guides as they lie in the package, below the folder TARGET. Links to what
# the package lacks become words, sample scenes get the place that they are installed at, and what is about the source
# alone is left out of the README.
use strict;
use warnings;

my $target = shift or die "usage: packaging/documents.pl TARGET\n";
my $installed = '/usr/share/doc/pathtracer';
my @documents = ('README.md', 'docs/scenes.md', 'docs/settings.md', 'docs/measuring.md');
my %there = map { $_ => 1 } @documents;
my $start = "## Start\n\n```sh\npathtracer $installed/examples/scenes/bigBalls.yaml 1280 720 10 20 bigBalls.png\n```\n\n"
    . "What is said to be in `src/`, `tests/`, `fuzz/` or `docs/pictures/make.sh`, and commands of `cargo`, belong to the source of the "
    . "program, which is not in the package.\n\n";

# A link of the document DOCUMENT, with the WORDS that it stands on.
sub link_of {
    my ($document, $words, $link) = @_;
    return "[$words]($link)" if $link =~ /^https?:|^#/;
    my ($file, $anchor) = $link =~ /^([^#]*)(#.*)?$/;
    my $folder = $document =~ m{^(.*/)} ? $1 : '';
    my $path = "$folder$file";
    1 while $path =~ s{[^/]+/\.\./}{};
    my $is_there = $there{$path} || $path =~ m{^(docs|scenes)/pictures/[^/]+\.(jpg|svg|png)$};
    return $is_there ? "[$words]($link)" : $words;
}

for my $document (@documents) {
    open my $in, '<', $document or die "$document: $!\n";
    my $text = do { local $/; <$in> };
    $text =~ s/^## Start\n.*?(?=^## )/$start/ms;
    $text =~ s/^## Code\n.*//ms;
    $text =~ s/\[([^\[\]]*)\]\(([^()\s]+)\)/link_of($document, $1, $2)/ge;
    $text =~ s{(?<![\w/.])scenes/(\w+\.yaml)}{$installed/examples/scenes/$1}g;
    open my $out, '>', "$target/$document" or die "$target/$document: $!\n";
    print $out $text;
    close $out or die "$target/$document: $!\n";
}
