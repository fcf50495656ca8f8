# The formula of a release is this one with version and checksum, which scripts/recipes fills in.
class Taut < Formula
  desc "Tight shapes around, through and inside point sets, with proof"
  homepage "https://taut-geometry.github.io/taut/"
  url "@REPOSITORY@/releases/download/v@VERSION@/taut-@VERSION@-source.tar.gz"
  sha256 "@SHA256@"
  license any_of: ["MIT", "Apache-2.0"]

  depends_on "rust" => :build

  def install
    system "cargo", "install", "--profile", "dist", *std_cargo_args(path: "crates/taut-cli")
    generate_completions_from_executable(bin/"taut", "completions")
    system bin/"taut", "man", man1
  end

  test do
    (testpath/"points.csv").write "0,0\n2,0\n1,1\n"
    system bin/"taut", "ball", "points.csv", "-o", "ball.json"
    assert_match "gap", shell_output("#{bin}/taut verify ball.json points.csv")
  end
end
